//! Pictures in rows and columns as one PNG, with their names drawn in. Between the pictures it is
//! transparent, and letters are of a grey that reads on white and on dark pages alike.

mod letters;

use super::{Pictures, Shown};
use crate::error::{Error, Result};
use image::{ImageFormat, Rgba, RgbaImage, imageops};
use letters::{Size, draw_lines, wrap};
use std::io::Cursor;

/// Pictures that are drawn larger fill this at most, side by side and each.
const MOST_WIDTH: u32 = 1030;
const MOST_SIDE: u32 = 400;
const MOST_TIMES: u32 = 4;
/// Pictures side by side that are wider than this are halved on a sheet.
const MOST_SHEET: u32 = 900;
const GAP: u32 = 14;
const BETWEEN_ROWS: u32 = 20;
const MOST_NAME: u32 = 170;

/// A picture's bytes as PNG, at its own size.
///
/// # Errors
/// [`Error::Internal`] where the picture has not as many bytes as pixels.
pub(super) fn picture(shown: &Shown) -> Result<Vec<u8>> {
    let size = (shown.width, shown.height);
    let fault = || {
        Error::Internal(format!(
            "a picture of {size:?} with {} bytes",
            shown.rgb.len()
        ))
    };
    let image = image::RgbImage::from_raw(size.0, size.1, shown.rgb.clone()).ok_or_else(fault)?;
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write_to(&mut bytes, ImageFormat::Png);
    written.map_err(|error| Error::Internal(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// Times that a picture is drawn larger: small ones, where there is room for them side by side.
pub(super) fn enlarged(pictures: &Pictures) -> u32 {
    let room = (MOST_WIDTH / columns(pictures) as u32).min(MOST_SIDE);
    (room / widest(pictures)).clamp(1, MOST_TIMES)
}

/// Pictures of the longest row, or names above them where these are more.
pub(super) fn columns(pictures: &Pictures) -> usize {
    let widths = pictures.rows.iter().map(|row| row.cells.len());
    widths.max().unwrap_or(0).max(pictures.columns.len()).max(1)
}

/// Width of the widest picture.
pub(super) fn widest(pictures: &Pictures) -> u32 {
    cells(pictures)
        .map(|cell| cell.width)
        .max()
        .unwrap_or(1)
        .max(1)
}

fn cells(pictures: &Pictures) -> impl Iterator<Item = &Shown> {
    pictures.rows.iter().flat_map(|row| &row.cells)
}

/// The whole block as PNG.
///
/// # Errors
/// [`Error::Internal`] where a picture has not as many bytes as pixels.
pub(super) fn sheet(pictures: &Pictures) -> Result<Vec<u8>> {
    let enlarged = enlarged(pictures);
    let pictures = &reduced(pictures)?;
    let plan = Plan::of(pictures, enlarged);
    let mut image = RgbaImage::new(plan.width, plan.height);
    for (column, name) in pictures.columns.iter().enumerate() {
        let lines = wrap(name, Size::Name, plan.side);
        let top = plan.head - Size::Name.height() * lines.len() as u32;
        let left = plan.column(column) + plan.side / 2;
        draw_lines(
            &mut image,
            &lines,
            Size::Name,
            [left, top.saturating_sub(8)],
            0.5,
        );
    }
    for (row, &top) in pictures.rows.iter().zip(&plan.tops) {
        let lines = wrap(&row.label, Size::Name, MOST_NAME);
        let tall = row.cells.iter().map(|cell| cell.height).max().unwrap_or(0) * plan.enlarged;
        let middle = top + tall.saturating_sub(Size::Name.height() * lines.len() as u32) / 2;
        let right = plan.names.saturating_sub(GAP);
        draw_lines(&mut image, &lines, Size::Name, [right, middle], 1.0);
        for (column, cell) in row.cells.iter().enumerate() {
            draw_cell(&mut image, cell, [plan.column(column), top], &plan)?;
        }
    }
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write_to(&mut bytes, ImageFormat::Png);
    written.map_err(|error| Error::Internal(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// With every second pixel of every second row where a sheet would be wider than a README shows it: their noise
/// stays what it is, which a mean would halve. The page has the pictures whole.
fn reduced(pictures: &Pictures) -> Result<Pictures> {
    let mut smaller = pictures.clone();
    if widest(pictures) * columns(pictures) as u32 > MOST_SHEET {
        for cell in smaller.rows.iter_mut().flat_map(|row| &mut row.cells) {
            halve(cell)?;
        }
    }
    Ok(smaller)
}

fn halve(shown: &mut Shown) -> Result<()> {
    let (width, height) = (shown.width.div_ceil(2), shown.height.div_ceil(2));
    let bytes = std::mem::take(&mut shown.rgb);
    let fault = || {
        Error::Internal(format!(
            "a picture of {} x {} without its pixels",
            shown.width, shown.height
        ))
    };
    let image = image::RgbImage::from_raw(shown.width, shown.height, bytes).ok_or_else(fault)?;
    let small = imageops::resize(&image, width, height, imageops::FilterType::Nearest);
    (shown.width, shown.height, shown.rgb) = (width, height, small.into_raw());
    Ok(())
}

/// Where everything is on a sheet.
struct Plan {
    enlarged: u32,
    /// Width of the widest picture, enlarged.
    side: u32,
    /// Width of the rows' names and height of the columns'.
    names: u32,
    head: u32,
    tops: Vec<u32>,
    width: u32,
    height: u32,
}

impl Plan {
    fn of(pictures: &Pictures, enlarged: u32) -> Self {
        let side = widest(pictures) * enlarged;
        let row_names = pictures
            .rows
            .iter()
            .flat_map(|row| wrap(&row.label, Size::Name, MOST_NAME));
        let longest = row_names
            .map(|line| Size::Name.width(&line))
            .max()
            .unwrap_or(0);
        let names = if longest == 0 { 0 } else { longest + GAP };
        let column_lines = pictures
            .columns
            .iter()
            .map(|name| wrap(name, Size::Name, side).len());
        let lines = column_lines.max().unwrap_or(0) as u32;
        let head = if lines == 0 {
            0
        } else {
            Size::Name.height() * lines + 8
        };
        let (mut tops, mut lower) = (Vec::new(), head);
        for row in &pictures.rows {
            tops.push(lower);
            let heights = row.cells.iter().map(|cell| {
                let notes = wrap(&cell.note, Size::Note, side).len() as u32;
                cell.height * enlarged
                    + if notes == 0 {
                        0
                    } else {
                        6 + Size::Note.height() * notes
                    }
            });
            lower += heights.max().unwrap_or(0) + BETWEEN_ROWS;
        }
        let columns = columns(pictures) as u32;
        Self {
            enlarged,
            side,
            names,
            head,
            width: (names + columns * (side + GAP)).saturating_sub(GAP).max(1),
            height: lower.saturating_sub(BETWEEN_ROWS).max(head).max(1),
            tops,
        }
    }

    fn column(&self, index: usize) -> u32 {
        self.names + index as u32 * (self.side + GAP)
    }
}

fn draw_cell(
    image: &mut RgbaImage,
    cell: &Shown,
    [left, top]: [u32; 2],
    plan: &Plan,
) -> Result<()> {
    let pixels = cell.rgb.as_chunks::<3>().0;
    if pixels.len() != cell.width as usize * cell.height as usize {
        return Err(Error::Internal(format!(
            "a picture of {} x {} with {} pixels",
            cell.width,
            cell.height,
            pixels.len()
        )));
    }
    let shift = (plan.side - cell.width * plan.enlarged) / 2;
    for y in 0..cell.height * plan.enlarged {
        for x in 0..cell.width * plan.enlarged {
            let index = (y / plan.enlarged) * cell.width + x / plan.enlarged;
            let [red, green, blue] = pixels[index as usize];
            image.put_pixel(left + shift + x, top + y, Rgba([red, green, blue, 255]));
        }
    }
    let lines = wrap(&cell.note, Size::Note, plan.side);
    let under = top + cell.height * plan.enlarged + 6;
    draw_lines(
        image,
        &lines,
        Size::Note,
        [left + plan.side / 2, under],
        0.5,
    );
    Ok(())
}
