//! `mansard explain`: the page of a diagnostic code.

use mansard::diagnostics::{explain, pages, suggest};

use crate::report::{self, Failure};

pub fn run(code: &str) -> Result<(), Failure> {
    match explain(code) {
        Some(page) => report::out(&format!("{page}\n")),
        None => {
            let near = suggest(code, pages().flat_map(|page| [page, page.split("::").last().unwrap_or(page)]));
            let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            Err(Failure::unable(format!("there is no page for `{code}`{help}")))
        }
    }
}
