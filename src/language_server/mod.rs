//! The language server: an editor's requests about rule files and recipes → its answers (Language Server Protocol 3.17).
