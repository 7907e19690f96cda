//! `mansard lsp`: the language server on standard input and output.

use mansard::language_server::{Ending, serve};

use crate::report::Failure;

/// Serves one client until it exits; leaving without `shutdown` is a failure, as the protocol has it.
pub fn run() -> Result<(), Failure> {
    let (connection, threads) = lsp_server::Connection::stdio();
    let ending = serve(connection);
    match ending {
        Ending::Orderly => {
            threads.join().map_err(|error| Failure::unable(format!("standard input or output: {error}")))
        }
        // The reading thread may wait for a client that is gone.
        Ending::Abrupt => Err(Failure::wrong("the client left without `shutdown`")),
    }
}
