//! Mailbox: what one thread wants of another. In: orders, posted at any time. Out: the newest of each kind, all at once;
//! what was overtaken is never done.

use std::sync::{Condvar, Mutex};

/// Orders of the type `T`, a struct with a field for each kind; its default asks for nothing.
#[derive(Debug, Default)]
pub struct Mailbox<T> {
    orders: Mutex<(T, bool)>,
    posted: Condvar,
}

impl<T: Default> Mailbox<T> {
    /// Changes what is wanted and wakes the reader.
    pub fn post(&self, change: impl FnOnce(&mut T)) {
        let mut orders = self.orders.lock().expect("no thread panics with the lock");
        change(&mut orders.0);
        orders.1 = true;
        self.posted.notify_one();
    }

    /// Waits for orders and takes them all.
    pub fn take(&self) -> T {
        let mut orders = self.orders.lock().expect("no thread panics with the lock");
        while !orders.1 {
            orders = self.posted.wait(orders).expect("no thread panics with the lock");
        }
        orders.1 = false;
        std::mem::take(&mut orders.0)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::Mailbox;

    #[derive(Debug, Default, PartialEq)]
    struct Orders {
        newest: Option<u32>,
        all: u32,
    }

    #[test]
    fn only_the_newest_counts() {
        let mailbox = Mailbox::<Orders>::default();
        for number in 1..=5 {
            mailbox.post(|orders| {
                orders.newest = Some(number);
                orders.all += 1;
            });
        }
        assert_eq!(mailbox.take(), Orders { newest: Some(5), all: 5 });
    }

    #[test]
    fn a_waiting_reader_wakes() {
        let mailbox = Arc::new(Mailbox::<Orders>::default());
        let reader = std::thread::spawn({
            let mailbox = mailbox.clone();
            move || mailbox.take()
        });
        mailbox.post(|orders| orders.newest = Some(7));
        assert_eq!(reader.join().expect("the reader does not panic").newest, Some(7));
    }
}
