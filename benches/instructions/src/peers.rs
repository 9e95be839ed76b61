//! What other generators were measured to cost (2026-11, callgrind, x86-64-v3, constant
//! parameters): instructions of one evaluation of M, h, C q̇, g, A, p₂, and of q̈.

/// Name, and instructions: slider–crank evaluation and accelerations, double four-bar
/// evaluation and accelerations.
pub const PLANAR: [(&str, [Option<u32>; 4]); 5] = [
    (
        "CasADi 3.8, C",
        [Some(486), Some(509), Some(1135), Some(1381)],
    ),
    ("SymForce 0.12, C++", [Some(386), None, Some(1022), None]),
    ("wrenfold 0.5, Rust", [Some(373), None, Some(920), None]),
    (
        "by hand in C, system sin/cos",
        [Some(335), Some(470), Some(880), Some(1442)],
    ),
    (
        "by hand in C, inlined sincos",
        [Some(123), Some(256), Some(314), Some(874)],
    ),
];

/// Mechanism, best peer, goal, and the kernel that counts ours.
pub const OTHERS: [(&str, u32, u32, &str); 5] = [
    ("Andrews' mechanism", 1685, 800, "andrews/terms"),
    ("spatial double pendulum", 1505, 800, "pendulum/terms"),
    ("six-link chain, recursion", 2368, 2300, "chain/terms"),
    ("10 loops in a row", 4273, 750, "row_10/terms"),
    ("40 loops in a row", 16383, 3000, "row_40/terms"),
];
