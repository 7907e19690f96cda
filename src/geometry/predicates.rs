//! Exact signs (bodies follow).
