//! Prints tables of figures that grow with a number, and how fast they do.

/// Is a table with one row per size.
pub struct Growth {
    title: String,
    columns: Vec<&'static str>,
    rows: Vec<(f64, Vec<f64>)>,
}

impl Growth {
    /// Makes a table. The first of `columns` names the number that the others grow with.
    pub fn new(title: impl Into<String>, columns: &[&'static str]) -> Self {
        Self {
            title: title.into(),
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    pub fn add(&mut self, size: f64, figures: impl Into<Vec<f64>>) {
        self.rows.push((size, figures.into()));
    }

    /// Prints the rows, and under each column the exponent of its growth: 0 is constant, 1 is in
    /// proportion.
    pub fn print(&self) {
        println!("\n{}", self.title);
        let header: String = self
            .columns
            .iter()
            .map(|column| format!("{column:>18}"))
            .collect();
        println!("{header}");
        for (size, figures) in &self.rows {
            let cells: String = figures
                .iter()
                .map(|figure| format!("{:>18}", rounded(*figure)))
                .collect();
            println!("{:>18}{cells}", rounded(*size));
        }
        let slopes: String = (0..self.columns.len() - 1)
            .map(|column| format!("{:>18}", rounded_slope(self.slope(column))))
            .collect();
        println!("{:>18}{slopes}", "log-log slope");
    }

    /// Returns the slope of least squares through the logarithms, without the row of size 0; `None`
    /// where another figure is not positive.
    fn slope(&self, column: usize) -> Option<f64> {
        let places: Vec<(f64, f64)> = self
            .rows
            .iter()
            .filter(|(size, figures)| *size > 0.0 && figures[column] > 0.0)
            .map(|(size, figures)| (size.ln(), figures[column].ln()))
            .collect();
        let sized = self.rows.iter().filter(|(size, _)| *size > 0.0);
        if places.len() < sized.count() || places.len() < 2 {
            return None;
        }
        let count = places.len() as f64;
        let mean_x = places.iter().map(|place| place.0).sum::<f64>() / count;
        let mean_y = places.iter().map(|place| place.1).sum::<f64>() / count;
        let together: f64 = places
            .iter()
            .map(|(x, y)| (x - mean_x) * (y - mean_y))
            .sum();
        let alone: f64 = places.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
        Some(together / alone)
    }
}

fn rounded(figure: f64) -> String {
    if figure.fract() == 0.0 && figure.abs() < 1e12 {
        format!("{figure:.0}")
    } else {
        format!("{figure:.3}")
    }
}

fn rounded_slope(slope: Option<f64>) -> String {
    slope.map_or_else(|| "-".to_owned(), |slope| format!("{slope:.2}"))
}
