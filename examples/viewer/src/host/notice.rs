//! Shows words in a window that no adapter can draw to. The CPU draws them.

use std::num::NonZeroU32;
use std::sync::Arc;

use ab_glyph::{Font, FontVec, PxScale, ScaleFont, point};
use winit::window::Window;

const BACKGROUND: u32 = 0x1b_1b_1b;
const INK: u32 = 0xdd_dd_dd;

/// Is the height of a line and the empty border in points.
const LINE: f32 = 22.0;
const BORDER: f32 = 40.0;

/// Holds the window and its words.
pub struct Notice {
    window: Arc<Window>,
    surface: softbuffer::Surface<Arc<Window>, Arc<Window>>,
    font: FontVec,
    text: String,
}

impl Notice {
    /// Takes over the window. Returns `None` where not even the CPU can draw to it.
    pub fn new(window: Arc<Window>, text: &str) -> Option<Self> {
        let context = softbuffer::Context::new(window.clone()).ok()?;
        let surface = softbuffer::Surface::new(&context, window.clone()).ok()?;
        let font = font()?;
        window.request_redraw();
        Some(Self {
            window,
            surface,
            font,
            text: text.to_owned(),
        })
    }

    /// Draws the words. A window that cannot be drawn to stays as it is: the words are on stderr as
    /// well.
    pub fn draw(&mut self) {
        let size = self.window.inner_size();
        let sides = [size.width, size.height].map(NonZeroU32::new);
        let [Some(width), Some(height)] = sides else {
            return;
        };
        let scale = self.window.scale_factor() as f32;
        if self.surface.resize(width, height).is_err() {
            return;
        }
        let Ok(mut buffer) = self.surface.buffer_mut() else {
            return;
        };
        let mut canvas = Canvas {
            pixels: vec![BACKGROUND; (size.width * size.height) as usize],
            width: size.width,
        };
        canvas.write(&self.font, &self.text, scale);
        buffer.copy_from_slice(&canvas.pixels);
        // The next redraw tries again.
        let _ = buffer.present();
    }
}

/// Is pixels of eight bits of red, green and blue, in rows.
struct Canvas {
    pixels: Vec<u32>,
    width: u32,
}

impl Canvas {
    /// Writes `text` in lines that fit between the borders.
    fn write(&mut self, font: &FontVec, text: &str, scale: f32) {
        let size = PxScale::from(LINE * 0.8 * scale);
        let border = BORDER * scale;
        let most = self.width as f32 - 2.0 * border;
        let scaled = font.as_scaled(size);
        let mut baseline = border + scaled.ascent();
        for line in wrapped(text, |line| advance(font, size, line) <= most) {
            let mut x = border;
            for letter in line.chars() {
                let id = font.glyph_id(letter);
                let glyph = id.with_scale_and_position(size, point(x, baseline));
                x += scaled.h_advance(id);
                if let Some(outline) = font.outline_glyph(glyph) {
                    let corner = outline.px_bounds().min;
                    outline.draw(|right, down, coverage| {
                        let at = [
                            corner.x as i64 + i64::from(right),
                            corner.y as i64 + i64::from(down),
                        ];
                        self.cover(at, coverage);
                    });
                }
            }
            baseline += LINE * scale;
        }
    }

    /// Mixes ink into a pixel, if there is one.
    fn cover(&mut self, [x, y]: [i64; 2], coverage: f32) {
        if x < 0 || y < 0 || x >= i64::from(self.width) {
            return;
        }
        let index = (y * i64::from(self.width) + x) as usize;
        if let Some(pixel) = self.pixels.get_mut(index) {
            let level = |shift: u32| {
                let [from, to] = [*pixel, INK].map(|color| ((color >> shift) & 255) as f32);
                ((from + (to - from) * coverage.clamp(0.0, 1.0)) as u32) << shift
            };
            *pixel = level(16) | level(8) | level(0);
        }
    }
}

/// Returns the font that egui has for its panels.
fn font() -> Option<FontVec> {
    let fonts = egui::FontDefinitions::default();
    let data = fonts.font_data.get("Ubuntu-Light")?;
    FontVec::try_from_vec((*data.font).as_ref().to_vec()).ok()
}

fn advance(font: &FontVec, size: PxScale, line: &str) -> f32 {
    let scaled = font.as_scaled(size);
    let letters = line.chars();
    letters
        .map(|letter| scaled.h_advance(font.glyph_id(letter)))
        .sum()
}

/// Breaks a text between words into lines that fit. A word that does not is a line of its own.
fn wrapped(text: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            let longer = if line.is_empty() {
                word.to_owned()
            } else {
                format!("{line} {word}")
            };
            if line.is_empty() || fits(&longer) {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            }
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        let lines = wrapped("one two three\n\nfour immeasurable", |line| line.len() <= 7);
        assert_eq!(lines, ["one two", "three", "", "four", "immeasurable"]);
    }

    #[test]
    fn words_leave_ink_in_the_window_alone() {
        let font = font().expect("a font");
        // The second line is below the last row, and the first word is wider than a row.
        let mut canvas = Canvas {
            pixels: vec![BACKGROUND; 120 * 70],
            width: 120,
        };
        canvas.write(&font, "immeasurable words", 1.0);
        let is_inked = |row: u32| {
            let start = (row * 120) as usize;
            canvas.pixels[start..start + 120]
                .iter()
                .any(|pixel| *pixel != BACKGROUND)
        };
        assert!((0..40).all(|row| !is_inked(row)), "the border is empty");
        assert!((40..62).any(is_inked), "the first line is there");
    }
}
