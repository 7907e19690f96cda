//! A queue ordered by exact time. In: events. Out: the earliest one.
//!
//! A binary heap of floats and numbers of events: integers are compared only where floats leave doubt.

use std::cmp::Ordering;

use super::events::Event;

/// An event by its number, with its time as a float.
#[derive(Clone, Copy, Debug)]
struct Item {
    tau: f64,
    event: u32,
}

/// Events that may happen.
#[derive(Debug, Default)]
pub(super) struct Heap {
    items: Vec<Item>,
    events: Vec<Event>,
}

impl Heap {
    pub fn clear(&mut self) {
        self.items.clear();
        self.events.clear();
    }

    pub fn push(&mut self, event: Event) {
        self.items.push(Item { tau: event.moment.tau, event: self.events.len() as u32 });
        self.events.push(event);
        self.sift_up(self.items.len() - 1);
    }

    pub fn peek(&self) -> Option<&Event> {
        self.items.first().map(|item| &self.events[item.event as usize])
    }

    /// Drop the earliest event.
    pub fn pop(&mut self) {
        let Some(last) = self.items.pop() else { return };
        let end = self.items.len();
        if end == 0 {
            return;
        }
        // Let the hole sink to the bottom, where the last item most likely belongs, then rise.
        let mut hole = 0;
        let mut child = 1;
        while child + 1 < end {
            if !self.earlier(self.items[child], self.items[child + 1]) {
                child += 1;
            }
            self.items[hole] = self.items[child];
            hole = child;
            child = 2 * hole + 1;
        }
        if child < end {
            self.items[hole] = self.items[child];
            hole = child;
        }
        self.items[hole] = last;
        self.sift_up(hole);
    }

    fn sift_up(&mut self, mut hole: usize) {
        let item = self.items[hole];
        while hole > 0 {
            let parent = (hole - 1) / 2;
            if !self.earlier(item, self.items[parent]) {
                break;
            }
            self.items[hole] = self.items[parent];
            hole = parent;
        }
        self.items[hole] = item;
    }

    fn earlier(&self, p: Item, q: Item) -> bool {
        let moment = |item: Item| &self.events[item.event as usize].moment;
        let gap = q.tau - p.tau;
        if gap.abs() > 1e-14 * (q.tau.abs() + p.tau.abs()) {
            return gap > 0.0;
        }
        moment(p).compare(moment(q)) == Ordering::Less
    }
}

#[cfg(test)]
mod tests {
    use super::super::events::Kind;
    use super::super::line::Moment;
    use super::*;

    #[test]
    fn gives_out_in_order_of_exact_time() {
        let mut heap = Heap::default();
        let big = 1 << 100;
        // Neighbours differ by less than a float can tell.
        let order: Vec<i128> = (0..50).map(|k| (k * 37) % 50).collect();
        for &k in &order {
            let kind = Kind::Edge { start: k as u32, end: 0 };
            heap.push(Event { moment: Moment::new(big + k, 3 * big), kind });
        }
        let mut seen = Vec::new();
        while let Some(&Event { kind: Kind::Edge { start, .. }, .. }) = heap.peek() {
            seen.push(start);
            heap.pop();
        }
        assert_eq!(seen, (0..50).collect::<Vec<u32>>());
    }
}
