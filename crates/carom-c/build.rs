//! Gives the shared library the name by which programs that are linked to it ask for it.
use std::env::var;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let of_package = |key: &str| var(format!("CARGO_PKG_VERSION_{key}")).unwrap_or_default();
    let (major, minor) = (of_package("MAJOR"), of_package("MINOR"));
    // Before 1.0 a new minor version may be another interface. install.sh names the files so, too.
    let interface = if major == "0" { format!("0.{minor}") } else { major };
    match var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("macos") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libcarom.{interface}.dylib")
        }
        Ok("windows") => {}
        _ => println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libcarom.so.{interface}"),
    }
}
