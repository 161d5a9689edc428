//! Reads scenes and reports the results: `cargo run -p durer-pov --example read -- SCENE.pov ...`
//!
//! With `--data` before the scenes, it also prints the scene data.

use std::process::ExitCode;

use durer_pov::{ReadOptions, read_with};

fn main() -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    let mut data = false;
    for argument in std::env::args().skip(1) {
        if argument == "--data" {
            data = true;
            continue;
        }
        match read_with(argument.as_ref(), &ReadOptions::default(), |message| eprint!("{message}")) {
            Ok(read) => {
                let (objects, lights) = (read.scene.objects.len(), read.scene.lights.len());
                println!("{argument}: objects: {objects}, lights: {lights}");
                if data {
                    println!("{:#?}", read.scene);
                }
            }
            Err(error) => {
                eprintln!("{error}");
                code = ExitCode::FAILURE;
            }
        }
    }
    code
}
