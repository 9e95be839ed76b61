//! Events that come in pairs within a step are found.
