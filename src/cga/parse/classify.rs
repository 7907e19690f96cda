//! In: the letters of all tokens. Out: the same letters where names that begin a declaration, a percentage, a dynamic
//! call or an operation with a block are told from other names, so that the grammar never looks ahead. Linear time.

use super::tokens::{MAX_BRACKETS, letter};

/// Behind the last token.
const NONE: u32 = u32::MAX;

pub fn classify(letters: &mut [u8]) {
    for i in 0..letters.len() {
        if letters[i] == b'%' && letters.get(i + 1) == Some(&b':') {
            letters[i] = letter::PERCENT;
        }
    }
    let partners = partners(letters);
    for i in (0..letters.len()).rev() {
        if letters[i].is_ascii_lowercase() {
            letters[i] = name(letters, &partners, i);
        }
    }
    for i in 0..letters.len() {
        if letters[i] == letter::PERCENT {
            weight(letters, &partners, i);
        }
    }
    limit_brackets(letters);
}

/// The other parenthesis of each parenthesis.
fn partners(letters: &[u8]) -> Vec<u32> {
    let mut partners = vec![NONE; letters.len()];
    let mut open = Vec::new();
    for (i, &l) in letters.iter().enumerate() {
        match l {
            b'(' => open.push(i),
            b')' => {
                if let Some(start) = open.pop() {
                    partners[start] = i as u32;
                    partners[i] = start as u32;
                }
            }
            _ => {}
        }
    }
    partners
}

/// The index behind the parentheses at `i`, `i` if none stand there, none if they are not closed.
fn behind_parentheses(letters: &[u8], partners: &[u32], i: usize) -> Option<usize> {
    match letters.get(i) {
        Some(b'(') => (partners[i] != NONE).then(|| partners[i] as usize + 1),
        _ => Some(i),
    }
}

/// The letter of the name at `i`; the letters behind it are final.
fn name(letters: &[u8], partners: &[u32], i: usize) -> u8 {
    let at = |i: usize| letters.get(i).copied().unwrap_or(0);
    let own = letters[i];
    let after = behind_parentheses(letters, partners, i + 1);
    let header = match after {
        Some(after) if at(after) == letter::WITH && at(after + 1) == b'(' => {
            behind_parentheses(letters, partners, after + 1)
        }
        _ => after,
    };
    match header.map_or(0, at) {
        letter::ARROW => return letter::RULE,
        // `->` and `-- >`: no expression holds them, so a rule was meant.
        b'-' if header.is_some_and(|h| at(h + 1) == b'>' || (at(h + 1) == b'-' && at(h + 2) == b'>')) => {
            return letter::RULE;
        }
        b'=' => return letter::FUNCTION,
        _ => {}
    }
    let called = after.filter(|&after| after > i + 1);
    if called.is_some_and(|after| at(after) == letter::DOT_NAME) {
        return letter::DYNAMIC;
    }
    let has_block = called.is_some_and(|after| at(after) == b'{');
    let is_kept = match own {
        letter::COMP | letter::SPLIT | letter::SELECTORS | letter::SCATTER | letter::PERIMETER => has_block,
        letter::INLINE | letter::BOOLEAN_OPERATION => {
            let mode = at(i + 1) == b'(' && at(i + 2).is_ascii_lowercase() && at(i + 3) == b')';
            let next = at(if mode { i + 4 } else { i + 1 });
            matches!(next, b'{' | b'[' | letter::NIL | b'a'..=b'v')
        }
        letter::MODIFIER => at(i + 1) == letter::RULE,
        letter::EXTENDS => true,
        _ => false,
    };
    if is_kept { own } else { letter::NAME }
}

/// Marks the first name of the percentage whose `%` stands at `percent`: operands with operators between them.
fn weight(letters: &mut [u8], partners: &[u32], percent: usize) {
    let mut end = percent;
    loop {
        let Some(start) = operand(letters, partners, end) else { return };
        let operator = start
            .checked_sub(1)
            .filter(|&i| matches!(letters[i], b'*' | b'/' | b'+' | b'-' | b'%' | letter::TIGHT_MINUS));
        match operator {
            Some(i) if operand(letters, partners, i).is_some() => end = i,
            _ => {
                if letters[start].is_ascii_lowercase() {
                    letters[start] = letter::WEIGHT;
                }
                return;
            }
        }
    }
}

/// The start of the operand that ends before `end`: a number, a name, a call or parentheses.
fn operand(letters: &[u8], partners: &[u32], end: usize) -> Option<usize> {
    let last = end.checked_sub(1)?;
    match letters[last] {
        letter::NUMBER => Some(last),
        // The name of a declaration is no operand: the `=` in front of `%` is a mistake.
        b'a'..=b'v' => Some(last),
        b')' if partners[last] != NONE => {
            let open = partners[last] as usize;
            let called = open.checked_sub(1).filter(|&i| matches!(letters[i], b'a'..=b'v'));
            Some(called.unwrap_or(open))
        }
        _ => None,
    }
}

/// Replaces brackets that are too deep, and with them what would cost stack.
fn limit_brackets(letters: &mut [u8]) {
    let mut depth = 0usize;
    for l in letters {
        match *l {
            b'(' | b'[' | b'{' => {
                depth += 1;
                if depth > MAX_BRACKETS {
                    *l = letter::TOO_DEEP;
                }
            }
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            // A bracket left open does not reach into the next declaration.
            letter::ATTR | letter::CONST | letter::IMPORT | letter::STYLE | letter::RULE => depth = 0,
            _ => {}
        }
    }
}
