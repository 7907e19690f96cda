//! Things made once per run. In: a key and how to make what belongs to it. Out: the same thing every time.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// Threads that want the same thing wait for the first; others go on.
#[derive(Debug)]
pub struct Cache<K, V> {
    known: RwLock<BTreeMap<K, Arc<OnceLock<V>>>>,
}

impl<K, V> Default for Cache<K, V> {
    fn default() -> Self {
        Cache { known: RwLock::default() }
    }
}

impl<K: Ord + Clone, V: Clone> Cache<K, V> {
    pub fn get<Q>(&self, key: &Q, make: impl FnOnce() -> V) -> V
    where
        K: std::borrow::Borrow<Q>,
        Q: Ord + ToOwned<Owned = K> + ?Sized,
    {
        // A thread that panicked while it held the lock left whole entries behind.
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner).get(key).cloned();
        let place = known.unwrap_or_else(|| {
            let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
            known.entry(key.to_owned()).or_default().clone()
        });
        place.get_or_init(make).clone()
    }
}
