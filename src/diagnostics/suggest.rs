//! In: a misspelt name and the names that exist. Out: the one that was probably meant.

/// The candidate nearest to `name` by Damerau-Levenshtein distance, ignoring case, if it is near enough
/// (a third of the length, at least 1). Ties go to the first candidate.
pub fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: Vec<char> = name.to_lowercase().chars().collect();
    let limit = (wanted.len() / 3).max(1);
    let letters = letters(name);
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        // Every letter that only one of them has costs a change: most names are refused without looking closer.
        let others = self::letters(candidate);
        let (ours, theirs) = (letters & !others, others & !letters);
        if (ours.count_ones().max(theirs.count_ones()) as usize) > limit {
            continue;
        }
        let other: Vec<char> = candidate.to_lowercase().chars().collect();
        if other.len().abs_diff(wanted.len()) > limit || candidate == name {
            continue;
        }
        let d = distance(&wanted, &other);
        if d <= limit && best.is_none_or(|(b, _)| d < b) {
            best = Some((d, candidate));
        }
    }
    best.map(|(_, c)| c)
}

/// The ASCII letters, digits and signs of a name as a set of bits; case is ignored, other characters count as one.
fn letters(name: &str) -> u64 {
    name.bytes().map(|b| if b.is_ascii() { 1 << (b.to_ascii_lowercase() & 63) } else { 1 << 63 }).fold(0, |a, b| a | b)
}

/// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let cost = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + cost);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::suggest;

    #[test]
    fn offers_the_nearest_name() {
        assert_eq!(suggest("extrud", ["extrude", "texture"]), Some("extrude"));
        assert_eq!(suggest("roofgabel", ["roofHip", "roofGable"]), Some("roofGable"));
        assert_eq!(suggest("zzz", ["extrude", "texture"]), None);
    }
}
