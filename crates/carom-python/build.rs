//! On macOS a module that Python loads finds Python's symbols when it is loaded; maturin says so to the linker, cargo alone does not.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    pyo3_build_config::add_extension_module_link_args();
}
