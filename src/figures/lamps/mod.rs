//! Figure 7: three ways to draw a point of the lamp, with a small and with a large lamp.

mod alone;
mod penumbra;
mod rooms;
mod worth;

use super::data::Data;
use super::figure::*;
use crate::error::Result;

/// The paper's rules and the unbiased ones.
const RULES: [(&str, &str); 2] = [("paper", "as published"), ("corrected", "corrected")];

const CASE_NAMES: [&str; 3] = ["case 1", "case 2", "case 3"];

/// # Errors
/// [`crate::Error::Usage`] where runs are missing.
pub fn figure(data: &Data) -> Result<Figure> {
    let rooms = rooms::Rooms::new(data)?;
    let penumbra = penumbra::Penumbra::new(data)?;
    let alone = alone::Alone::new(data)?;
    let worth = worth::Worth::new(data)?;
    let mut blocks = vec![Block::Pictures(rooms::pictures(data)?)];
    blocks.extend(rooms.blocks());
    blocks.push(Block::Table(worth.table()));
    blocks.push(Block::Plots(penumbra.plots()));
    blocks.push(Block::Plots(alone.plots()));
    let results = [
        rooms.results(),
        worth.results(),
        penumbra.results(),
        alone.results(),
    ]
    .concat();
    Ok(Figure {
        number: 7,
        title: "Three ways to draw a point of the lamp".into(),
        claim: "With 50 samples a pixel there is no clear difference between the three cases, for a small and for a large \
                lamp: case 1, though not even over the sphere, can be used for the same result."
            .into(),
        reading: "As published a drawn point counts with the solid angle of the lamp at the point's distance, whichever case drew \
                  it, and it is lit if the first object on the way to it is the lamp. Corrected, it counts with one over the case's \
                  density, and only where it faces the lit point. Both lamps have one power, and radii of 0.06 and 0.3 in a room 2 wide. Shadow rays alone find the lamp, as in \
                  the paper, so that nothing but the case differs."
            .into(),
        verdict: rooms.verdict(&penumbra),
        results,
        blocks,
        commands: data.commands(7),
        sweeps: data.pages(7),
        data: vec![rooms.csv(), penumbra.csv(), alone.csv()],
    })
}
