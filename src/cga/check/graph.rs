//! In: a directed graph as lists of successors. Out: its strongly connected components (Tarjan, "Depth-first search
//! and linear graph algorithms", 1972), without recursion, because chains of rules can be long.

/// The components, each after all components it leads to; the members of one are in the order of their numbers.
pub fn components(edges: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut search = Search {
        edges,
        number: vec![NEW; edges.len()],
        low: vec![0; edges.len()],
        waiting: vec![false; edges.len()],
        stack: Vec::new(),
        next: 0,
        out: Vec::new(),
    };
    for node in 0..edges.len() {
        if search.number[node] == NEW {
            search.from(node);
        }
    }
    search.out
}

/// Whether a component is a ring: more than one node, or one that leads to itself.
pub fn is_ring(component: &[usize], edges: &[Vec<usize>]) -> bool {
    component.len() > 1 || component.iter().any(|node| edges[*node].contains(node))
}

const NEW: usize = usize::MAX;

struct Search<'e> {
    edges: &'e [Vec<usize>],
    number: Vec<usize>,
    /// Least number reachable through waiting nodes.
    low: Vec<usize>,
    waiting: Vec<bool>,
    stack: Vec<usize>,
    next: usize,
    out: Vec<Vec<usize>>,
}

impl Search<'_> {
    fn from(&mut self, root: usize) {
        self.open(root);
        let mut path = vec![(root, 0)];
        while let Some((node, edge)) = path.last_mut() {
            let node = *node;
            let Some(&target) = self.edges[node].get(*edge) else {
                path.pop();
                if let Some((parent, _)) = path.last() {
                    self.low[*parent] = self.low[*parent].min(self.low[node]);
                }
                self.close(node);
                continue;
            };
            *edge += 1;
            if self.number[target] == NEW {
                self.open(target);
                path.push((target, 0));
            } else if self.waiting[target] {
                self.low[node] = self.low[node].min(self.number[target]);
            }
        }
    }

    fn open(&mut self, node: usize) {
        (self.number[node], self.low[node]) = (self.next, self.next);
        self.next += 1;
        self.waiting[node] = true;
        self.stack.push(node);
    }

    fn close(&mut self, node: usize) {
        if self.low[node] != self.number[node] {
            return;
        }
        let mut component = Vec::new();
        while let Some(member) = self.stack.pop() {
            self.waiting[member] = false;
            component.push(member);
            if member == node {
                break;
            }
        }
        component.sort_unstable();
        self.out.push(component);
    }
}

#[cfg(test)]
mod tests {
    use super::{components, is_ring};

    #[test]
    fn components_stand_behind_what_they_lead_to() {
        let edges = vec![vec![1], vec![2, 3], vec![0], vec![], vec![4], vec![3]];
        let found = components(&edges);
        assert_eq!(found, [vec![3], vec![0, 1, 2], vec![4], vec![5]]);
        let rings: Vec<bool> = found.iter().map(|c| is_ring(c, &edges)).collect();
        assert_eq!(rings, [false, true, true, false]);
    }

    #[test]
    fn a_long_chain_needs_no_stack() {
        let edges: Vec<Vec<usize>> = (0..200_000).map(|i| vec![(i + 1) % 200_000]).collect();
        assert_eq!(components(&edges).len(), 1);
    }
}
