//! The versions of the standard, and what differs between them.

/// A version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl Version {
    /// As the standard writes it.
    pub fn number(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }

    /// The file of the functions, and what is in it.
    pub fn functions(self) -> (&'static str, &'static str) {
        match self {
            Self::Two => ("fmi2.c", include_str!("fmi2.c")),
            Self::Three => ("fmi3.c", include_str!("fmi3.c")),
        }
    }

    /// The folder of libraries for this machine.
    pub fn platform(self) -> String {
        let system = match (cfg!(windows), cfg!(target_os = "macos")) {
            (true, _) => ["win64", "windows"],
            (_, true) => ["darwin64", "darwin"],
            _ => ["linux64", "linux"],
        };
        match self {
            Self::Two => system[0].to_string(),
            Self::Three => format!("{}-{}", std::env::consts::ARCH, system[1]),
        }
    }
}
