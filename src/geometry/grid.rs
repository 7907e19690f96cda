//! Integer grid of a footprint (bodies follow).
