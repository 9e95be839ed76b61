//! Mechanisms in one library, for programs in C.

bricard_runtime::include_mechanism!("engine");
bricard_runtime::include_mechanism!("motor");
bricard_runtime::include_mechanism!("double_pendulum");
