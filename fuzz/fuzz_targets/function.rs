//! Any text as the body of a function: read, or refused with a message; never a panic.
#![no_main]

use std::io::Write;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = std::env::temp_dir().join(format!("durer-fuzz-{}.pov", std::process::id()));
    let Ok(mut file) = std::fs::File::create(&path) else { return };
    let _ = file.write_all(b"#version 3.7;\n#declare F = function(x, y, z, a) { ");
    let _ = file.write_all(data);
    let _ = file.write_all(b" };\n#declare V = F(0.1, 0.2, 0.3, 4);\n");
    drop(file);
    let _ = durer_pov::read(&path, &durer_pov::ReadOptions::default());
});
