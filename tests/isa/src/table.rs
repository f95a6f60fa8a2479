//! Reads, writes and compares the table of figures.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::Figures;

/// Is the first line of the columns.
const COLUMNS: &str = "composition,family,vgprs,waves,instructions,latency,inverse_throughput";

/// Is the share by which a figure may worsen before the table must be updated.
const TOLERANCE: f64 = 0.03;

/// Holds the figures of one version of the driver.
#[derive(Default)]
pub struct Table {
    /// Names the driver and its version.
    pub driver: String,
    /// Holds the rows in the order in which they were compiled.
    pub rows: Vec<Row>,
}

/// Holds the figures of a shader on one chip.
pub struct Row {
    /// Names the shader.
    pub composition: String,
    /// Names the chip.
    pub family: String,
    /// Holds what the compiler says.
    pub figures: Figures,
}

impl Row {
    /// Returns the figures from words in the order of the columns, or `None` where they are not so
    /// many whole numbers.
    pub fn figures<'a>(words: impl Iterator<Item = &'a str>) -> Option<Figures> {
        let numbers: Result<Vec<u64>, _> = words.map(str::parse).collect();
        let &[vgprs, waves, instructions, latency, inverse_throughput] = &numbers.ok()?[..] else {
            return None;
        };
        Some(Figures {
            vgprs,
            waves,
            instructions,
            latency,
            inverse_throughput,
        })
    }

    fn csv(&self) -> String {
        let Self {
            composition,
            family,
            figures,
        } = self;
        format!(
            "{composition},{family},{},{},{},{},{}",
            figures.vgprs,
            figures.waves,
            figures.instructions,
            figures.latency,
            figures.inverse_throughput
        )
    }
}

impl Table {
    /// Returns the rows as CSV.
    pub fn csv(&self) -> String {
        let mut text = format!("{COLUMNS}\n");
        for row in &self.rows {
            text += &row.csv();
            text.push('\n');
        }
        text
    }

    /// Returns the table that `text` holds: rows as CSV, below a line that begins with `#` and
    /// names the driver.
    ///
    /// # Errors
    /// Returns a message that names the first line that is no row.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut table = Self::default();
        for line in text.lines() {
            if let Some(driver) = line.strip_prefix("# ") {
                table.driver = driver.to_owned();
            } else if line != COLUMNS {
                let mut words = line.split(',');
                let names = [(); 2].map(|()| words.next().unwrap_or_default().to_owned());
                let [composition, family] = names;
                let figures = Row::figures(words).ok_or_else(|| format!("no row: {line}"))?;
                table.rows.push(Row {
                    composition,
                    family,
                    figures,
                });
            }
        }
        Ok(table)
    }

    /// Returns what is worse here than in `before`, or in one of the tables alone, a line each.
    pub fn worse_than(&self, before: &Self) -> String {
        if self.driver != before.driver {
            return format!(
                "the table is of {}, and this is {}\n",
                before.driver, self.driver
            );
        }
        let key = |row: &Row| (row.composition.clone(), row.family.clone());
        let mut known: BTreeMap<_, _> = before
            .rows
            .iter()
            .map(|row| (key(row), row.figures))
            .collect();
        let mut text = String::new();
        for row in &self.rows {
            let (composition, family) = key(row);
            let Some(old) = known.remove(&(composition, family)) else {
                let _ = writeln!(text, "new: {}", row.csv());
                continue;
            };
            let new = row.figures;
            let grew = |new: u64, old: u64| new as f64 > old as f64 * (1.0 + TOLERANCE);
            if new.waves < old.waves
                || grew(new.instructions, old.instructions)
                || grew(new.latency, old.latency)
                || grew(new.inverse_throughput, old.inverse_throughput)
            {
                let _ = writeln!(text, "worse: {}, was {old:?}", row.csv());
            }
        }
        for (composition, family) in known.keys() {
            let _ = writeln!(text, "gone: {composition} on {family}");
        }
        text
    }

    /// Returns the rows of one family for a person to read.
    pub fn readable(&self, family: &str) -> String {
        let mut text = format!(
            "{family}, {}\n{:<40}{:>6}{:>6}{:>13}{:>9}{:>20}\n",
            self.driver, "", "VGPRs", "waves", "instructions", "latency", "inverse throughput"
        );
        for row in self.rows.iter().filter(|row| row.family == family) {
            let Figures {
                vgprs,
                waves,
                instructions,
                latency,
                inverse_throughput,
            } = row.figures;
            let _ = writeln!(
                text,
                "{:<40}{vgprs:>6}{waves:>6}{instructions:>13}{latency:>9}{inverse_throughput:>20}",
                row.composition
            );
        }
        text
    }
}
