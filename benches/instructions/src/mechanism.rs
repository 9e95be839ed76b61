//! The generated mechanisms that are counted.

macro_rules! generated {
    ($($(#[$docs:meta])* $place:ident: $folder:literal / $file:literal;)*) => {
        $(
            $(#[$docs])*
            pub mod $place {
                include!(concat!(env!("OUT_DIR"), "/", $folder, "/", $file, ".rs"));
            }
        )*
    };
}

generated! {
    /// All parameters folded.
    slider_crank_folded: "folded" / "slider_crank";
    /// All parameters folded.
    double_four_bar_folded: "folded" / "double_four_bar";
    /// Seven bodies in three loops.
    andrews_folded: "folded" / "andrews";
    /// Two rods in space.
    pendulum: "folded" / "spatial_double_pendulum";
    /// Six links in space.
    chain: "folded" / "spatial_chain";
    /// Parameters set when the program runs.
    slider_crank_open: "open" / "slider_crank";
    /// Parameters set when the program runs.
    double_four_bar_open: "open" / "double_four_bar";
    /// Parameters folded, all coordinates in the state.
    scotch_yoke_folded: "folded" / "scotch_yoke";
    /// Parameters folded, all coordinates in the state.
    quick_return_folded: "folded" / "quick_return";
    /// Parameters folded, coordinates that constraints give left out.
    slider_crank_eliminated: "eliminated" / "slider_crank";
    /// Parameters folded, coordinates that constraints give left out.
    scotch_yoke_eliminated: "eliminated" / "scotch_yoke";
    /// Parameters folded, coordinates that constraints give left out.
    quick_return_eliminated: "eliminated" / "quick_return";
    /// 10 parallelograms.
    row_10: "row_10" / "n_four_bar";
    /// 40 parallelograms.
    row_40: "row_40" / "n_four_bar";
    /// 10 swings.
    swings_10: "chain_10" / "swings";
    /// 10 parallelograms and a pendulum.
    hung_10: "chain_10" / "hung_row";
    /// 10 rods in joint angles.
    joint_10: "joint_10" / "joint_chain";
    /// 20 rods in joint angles.
    joint_20: "joint_20" / "joint_chain";
    /// 50 rods in joint angles.
    joint_50: "joint_50" / "joint_chain";
}

#[cfg(feature = "long")]
generated! {
    /// 2 parallelograms.
    row_2: "row_2" / "n_four_bar";
    /// 5 parallelograms.
    row_5: "row_5" / "n_four_bar";
    /// 20 parallelograms.
    row_20: "row_20" / "n_four_bar";
    /// 80 parallelograms.
    row_80: "row_80" / "n_four_bar";
    /// 20 swings.
    swings_20: "chain_20" / "swings";
    /// 40 swings.
    swings_40: "chain_40" / "swings";
    /// 20 parallelograms and a pendulum.
    hung_20: "chain_20" / "hung_row";
    /// 40 parallelograms and a pendulum.
    hung_40: "chain_40" / "hung_row";
}
