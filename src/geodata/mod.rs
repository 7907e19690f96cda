//! Map and elevation: files → [`site::Site`] (local frame, features, terrain).

pub mod feature;
pub mod ledger;
