//! Compiles shaders for several chips, each in a process of its own: a driver is told its chip when
//! it is loaded.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::Command;

use shadow_isa::{Compiler, Driver, Figures, Row, Table};
use shadow_support::compositions::Composition;

/// Compiles `compositions` for the chips of `families`, through files in `folder`.
pub fn of(
    compositions: &[Composition],
    families: &[String],
    folder: &Path,
) -> Result<Table, Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    let mut list = String::new();
    for (index, composition) in compositions.iter().enumerate() {
        fs::write(folder.join(format!("{index}.wgsl")), &composition.wgsl)?;
        let fragment = composition.fragment.unwrap_or_default();
        list += &format!("{} {fragment}\n", composition.vertex);
    }
    fs::write(folder.join("entries.txt"), list)?;
    let driver = Driver::find()?;
    let mut table = Table::default();
    for family in families {
        let child = Command::new(std::env::current_exe()?)
            .arg("--compile")
            .arg(folder)
            .envs(driver.variables(family))
            .output()?;
        let text = String::from_utf8(child.stdout)?;
        let mut lines = text.lines();
        let failure = || {
            let message = String::from_utf8_lossy(&child.stderr);
            format!("{family}: {} {message}", child.status)
        };
        table.driver = lines.next().ok_or_else(failure)?.to_owned();
        let rows = lines.zip(compositions).map(|(line, composition)| {
            let figures = Row::figures(line.split(' '))?;
            Some(Row {
                composition: composition.name.clone(),
                family: family.clone(),
                figures,
            })
        });
        let rows: Vec<_> = rows.collect::<Option<_>>().ok_or_else(failure)?;
        if !child.status.success() || rows.len() != compositions.len() {
            return Err(failure().into());
        }
        table.rows.extend(rows);
    }
    Ok(table)
}

/// Compiles the files in `folder`, and prints the driver and a line of figures for each.
pub fn print(folder: &Path) -> Result<(), Box<dyn Error>> {
    let compiler = Compiler::new()?;
    println!("{}", compiler.driver());
    let entries = fs::read_to_string(folder.join("entries.txt"))?;
    for (index, line) in entries.lines().enumerate() {
        let wgsl = fs::read_to_string(folder.join(format!("{index}.wgsl")))?;
        let (vertex, fragment) = line.split_once(' ').unwrap_or((line, ""));
        let fragment = (!fragment.is_empty()).then_some(fragment);
        let Figures {
            vgprs,
            waves,
            instructions,
            latency,
            inverse_throughput,
        } = compiler.compile(&wgsl, vertex, fragment)?;
        println!("{vgprs} {waves} {instructions} {latency} {inverse_throughput}");
    }
    Ok(())
}
