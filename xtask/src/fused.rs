//! `cargo xtask fused`: checks that code for CPUs with fused operations never calls the library
//! function `fma`.
//!
//! `f64::mul_add` is one instruction in code that is compiled for CPUs that have it, and a slow
//! call elsewhere. Everything below a query must be inlined into the one function that switches the
//! instructions on, called the door, or must enter a door again. The compiler gives no message when
//! that fails. This task reads the release binary. It disassembles it, because it needs to know
//! which function calls which:
//!
//! - *fused* functions contain a fused instruction, or are a door themselves;
//! - *plain* functions contain none. A plain function that calls fused ones is a door: it chooses
//!   at run time, and its plain half is for other CPUs;
//! - a plain function is an error if it calls `fma` and a fused function reaches it without passing
//!   a door.
//!
//! Calls through pointers (trait objects) are not seen.

use crate::Outcome;
use crate::command::Durer;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// Checks the named binary, or the `durer` command as built for release.
pub(crate) fn run(words: &[String]) -> Outcome {
    let binary = match words {
        [] => Durer::build()?.program().to_path_buf(),
        [path] => path.into(),
        _ => return Err("fused: at most one binary".into()),
    };
    let listing = objdump(&["-d", "-C", "--no-show-raw-insn"], &binary)?;
    let program = Program::read(&objdump(&["-R"], &binary)?, &listing);
    let fused = program.functions.values().filter(|f| f.is_fused).count();
    if fused == 0 {
        return Err(format!(
            "{}: no function with fused instructions; is it stripped, or not for x86-64?",
            binary.display()
        ));
    }
    let strays = program.strays();
    println!("{fused} fused functions; {} plain ones below them call fma:", strays.len());
    for stray in &strays {
        println!("  {:3} calls in {}\n            from {}", stray.calls, stray.name, stray.from);
    }
    if strays.is_empty() {
        Ok(())
    } else {
        Err(format!("{} functions call fma where it should be one instruction", strays.len()))
    }
}

fn objdump(flags: &[&str], binary: &Path) -> Outcome<String> {
    let output =
        Command::new("objdump").args(flags).arg(binary).output().map_err(|e| format!("objdump: {e}"))?;
    if !output.status.success() {
        return Err(format!("objdump: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[derive(Debug, Default)]
struct Function<'t> {
    name: &'t str,
    is_fused: bool,
    /// The addresses that it calls or jumps to.
    calls: Vec<u64>,
}

/// A program's functions by their addresses.
#[derive(Debug)]
struct Program<'t> {
    functions: BTreeMap<u64, Function<'t>>,
}

/// A function that calls `fma` but should not.
#[derive(Debug, PartialEq)]
struct Stray<'t> {
    name: &'t str,
    calls: usize,
    /// The name of a caller.
    from: &'t str,
}

fn hex(digits: &str) -> Option<u64> {
    u64::from_str_radix(digits, 16).ok()
}

impl<'t> Program<'t> {
    /// Reads the output of `objdump -R` and `objdump -d -C`.
    fn read(relocations: &str, listing: &'t str) -> Self {
        // Addresses that the loader writes into the table of functions.
        let table: BTreeMap<u64, u64> = relocations
            .lines()
            .filter_map(|line| {
                let (slot, target) = line.split_once(" R_X86_64_RELATIVE")?;
                Some((hex(slot.trim())?, hex(target.trim().strip_prefix("*ABS*+0x")?)?))
            })
            .collect();
        let mut functions = BTreeMap::new();
        let mut here: Option<(u64, Function<'t>)> = None;
        for line in listing.lines() {
            if let Some((address, name)) = line.strip_suffix(">:").and_then(|l| l.split_once(" <")) {
                functions.extend(here.take());
                let is_door = name.contains("::kernels::run_");
                here = hex(address).map(|a| (a, Function { name, is_fused: is_door, calls: Vec::new() }));
                continue;
            }
            let (Some((address, function)), Some((_, instruction))) = (&mut here, line.split_once(":\t"))
            else {
                continue;
            };
            let (mnemonic, operand) = instruction.split_once(' ').unwrap_or((instruction, ""));
            function.is_fused |=
                ["vfmadd", "vfmsub", "vfnmadd", "vfnmsub"].iter().any(|m| mnemonic.starts_with(m));
            if mnemonic.starts_with("call") || mnemonic == "jmp" {
                let target = match operand.split_once("# ") {
                    Some((_, slot)) => {
                        slot.split(' ').next().and_then(hex).and_then(|s| table.get(&s).copied())
                    }
                    None => operand.trim().split(' ').next().and_then(hex),
                };
                // A jump within the function itself does not count.
                function.calls.extend(target.filter(|t| {
                    t != address && (mnemonic != "jmp" || operand.ends_with('>') && !operand.contains("+0x"))
                }));
            }
        }
        functions.extend(here);
        Self { functions }
    }

    fn strays(&self) -> Vec<Stray<'t>> {
        let is_fma =
            |address: &u64| self.functions.get(address).is_some_and(|f| matches!(f.name, "fma" | "fma@plt"));
        let is_fused = |address: &u64| self.functions.get(address).is_some_and(|f| f.is_fused);
        let is_door = |f: &Function<'_>| f.calls.iter().any(is_fused);
        let mut seen = BTreeSet::new();
        let mut strays = Vec::new();
        let mut next: Vec<&Function<'t>> = self.functions.values().filter(|f| f.is_fused).collect();
        while let Some(from) = next.pop() {
            for address in &from.calls {
                let Some(function) = self.functions.get(address) else { continue };
                if function.is_fused || is_door(function) || is_fma(address) || !seen.insert(*address) {
                    continue;
                }
                let calls = function.calls.iter().filter(|a| is_fma(a)).count();
                if calls > 0 {
                    strays.push(Stray { name: function.name, calls, from: from.name });
                }
                next.push(function);
            }
        }
        strays.sort_by_key(|s| (core::cmp::Reverse(s.calls), s.name));
        strays
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_code_below_fused_code_is_found() {
        let relocations = "0000000000000f00 R_X86_64_RELATIVE  *ABS*+0x0000000000000900\n";
        let listing = "\
0000000000000100 <fused>:
     100:\tvfmadd213sd %xmm1,%xmm0,%xmm2
     104:\tcall   200 <stray>
     108:\tcall   300 <between>
     10c:\tcall   400 <door>
     110:\tjmp    108 <fused+0x8>

0000000000000200 <stray>:
     200:\tcall   *0xd00(%rip)        # f00 <table>

0000000000000300 <between>:
     300:\tjmp    500 <behind>

0000000000000400 <door>:
     400:\tcall   100 <fused>
     404:\tcall   *0xd00(%rip)        # f00 <table>

0000000000000500 <behind>:
     500:\tcall   900 <fma>
     504:\tcall   900 <fma>

0000000000000600 <elsewhere>:
     600:\tcall   900 <fma>

0000000000000900 <fma>:
     900:\tret
";
        let strays = Program::read(relocations, listing).strays();
        let found: Vec<_> = strays.iter().map(|s| (s.name, s.calls, s.from)).collect();
        assert_eq!(found, [("behind", 2, "between"), ("stray", 1, "fused")]);
    }
}
