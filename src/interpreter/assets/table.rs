//! Tables. In: the text of a `.csv` file. Out: its cells in rows of equal length (reference 6.5, `readStringTable`).

use std::sync::Arc;

use crate::interpreter::value::Array;

/// The cells; short rows are filled with empty ones. Empty lines are left out.
pub fn read(text: &str, most: usize) -> Result<Array<Arc<str>>, String> {
    let mut rows = Rows { rows: Vec::new(), cells: 0, most };
    match delimiter(text) {
        b' ' => {
            for line in text.lines().filter(|l| !l.trim().is_empty()) {
                rows.add(line.split_whitespace())?;
            }
        }
        delimiter => {
            let mut reader = csv::ReaderBuilder::new();
            reader.has_headers(false).flexible(true).delimiter(delimiter).trim(csv::Trim::All);
            for record in reader.from_reader(text.as_bytes()).records() {
                rows.add(record.map_err(|e| e.to_string())?.iter())?;
            }
        }
    }
    rows.filled()
}

struct Rows {
    rows: Vec<Vec<Arc<str>>>,
    cells: usize,
    most: usize,
}

impl Rows {
    fn add<'c>(&mut self, cells: impl Iterator<Item = &'c str>) -> Result<(), String> {
        let row: Vec<Arc<str>> = cells.take(self.most - self.cells + 1).map(Arc::from).collect();
        self.cells += row.len();
        if self.cells > self.most {
            return Err(format!("it has more than {} cells", self.most));
        }
        self.rows.push(row);
        Ok(())
    }

    fn filled(self) -> Result<Array<Arc<str>>, String> {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        if self.rows.len().saturating_mul(columns) > self.most {
            return Err(format!("it is a table of {} x {columns} cells, more than {}", self.rows.len(), self.most));
        }
        let empty: Arc<str> = "".into();
        let rows = self.rows.len();
        let filled = |mut row: Vec<Arc<str>>| {
            row.resize(columns, empty.clone());
            row
        };
        Ok(Array { rows, columns, items: self.rows.into_iter().flat_map(filled).collect() })
    }
}

/// The rarer the character is in plain text, the sooner it is taken for the delimiter: the first of tab, semicolon,
/// comma, space that stands outside quotes in the first line.
fn delimiter(text: &str) -> u8 {
    let line = text.lines().find(|l| !l.trim().is_empty()).unwrap_or("").trim();
    let mut quoted = false;
    let mut seen = [false; 256];
    for b in line.bytes() {
        quoted ^= b == b'"';
        seen[usize::from(b)] |= !quoted;
    }
    *b"\t;, ".iter().find(|&&d| seen[usize::from(d)]).unwrap_or(&b',')
}

#[cfg(test)]
mod tests {
    use super::read;

    #[track_caller]
    fn cells(text: &str, expected: &[&[&str]]) {
        let table = read(text, 100).expect("it is small");
        assert_eq!((table.rows, table.columns), (expected.len(), expected.first().map_or(0, |r| r.len())), "{text}");
        let flat: Vec<&str> = table.items.iter().map(|s| &**s).collect();
        assert_eq!(flat, expected.concat(), "{text}");
    }

    #[test]
    fn the_delimiter_is_found() {
        cells("a,b\n1,2\n", &[&["a", "b"], &["1", "2"]]);
        cells("a;1,5\r\nb;2,5", &[&["a", "1,5"], &["b", "2,5"]]);
        cells("a b\tc\nd\te f\n", &[&["a b", "c"], &["d", "e f"]]);
        cells("1  2 3\n4 5 6", &[&["1", "2", "3"], &["4", "5", "6"]]);
        cells("one\ntwo\n", &[&["one"], &["two"]]);
        cells("", &[]);
    }

    #[test]
    fn quotes_hold_delimiters_and_short_rows_are_filled() {
        cells("\"a;b, c\",\"say \"\"hi\"\"\"\nx\n\n", &[&["a;b, c", "say \"hi\""], &["x", ""]]);
    }

    #[test]
    fn a_table_that_would_grow_when_filled_is_refused() {
        let wide = format!("{}\n{}", ",".repeat(50), "a\n".repeat(50));
        assert!(read(&wide, 200).is_err_and(|e| e.contains("51 x 51")));
        assert!(read(&wide, 40).is_err_and(|e| e.contains("more than 40 cells")));
    }
}
