//! One part, float32, lossless, with the record and the scene text as attributes.

use super::channels::{Plane, planes};
use crate::film::{Picture, text};
use exr::block::UncompressedBlock;
use exr::block::writer::ChunksWriter;
use exr::meta::BlockDescription;
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::prelude::{
    AttributeValue, ChannelDescription, Compression, LineOrder, SampleType, SmallVec, Text,
};
use std::io::{self, Seek, Write};

/// Writes a picture whose planes all have its size.
pub(in crate::film) fn write_exr(picture: &Picture, writer: impl Write + Seek) -> io::Result<()> {
    let planes = planes(picture);
    let header = header(picture, &planes)?;
    let channels = header.channels.clone();
    let headers = std::iter::once(header).collect();
    exr::block::write(writer, headers, true, |meta, writer| {
        let blocks = meta.collect_ordered_blocks(|index| {
            UncompressedBlock::from_lines(&channels, index, |line| {
                let at = line.location;
                let start = at.position.y() * picture.width as usize + at.position.x();
                let plane = &planes[at.channel].1;
                // Both sides are memory: this cannot fail.
                let _ = line.write_samples(|sample| plane.value(start + sample));
            })
        });
        // With lines in increasing order the threads' blocks are sorted before they are written,
        // so that the file does not depend on which of them is ready first.
        writer
            .on_progress(|_| ())
            .compress_all_blocks_parallel(&meta, blocks)
    })
    .map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        error => io::Error::other(error.to_string()),
    })
}

fn header(picture: &Picture, planes: &[(&str, Plane)]) -> io::Result<Header> {
    let channel =
        |(name, _): &(&str, Plane)| ChannelDescription::new(string(name), SampleType::F32, false);
    let channels: SmallVec<[ChannelDescription; 5]> = planes.iter().map(channel).collect();
    let size = (picture.width as usize, picture.height as usize);

    // The crate keeps further attributes in hash maps, whose order changes from run to run. It has
    // one for the file and one for the layer; a single entry in each keeps the bytes the same.
    let mut shared = ImageAttributes::with_size(size);
    let mut own = LayerAttributes::default();
    let record = AttributeValue::Text(string(&picture.record.to_even_json()));
    own.other.insert(string("lampray"), record);
    if let Some(scene_text) = text::portable(picture.scene_text.as_deref()) {
        let bytes = SmallVec::from_vec(text::compress(scene_text)?);
        let scene = AttributeValue::Custom {
            kind: string("zlib"),
            bytes,
        };
        shared.other.insert(string("lampray_scene"), scene);
    }
    Ok(Header::new(string(""), size, channels)
        .with_encoding(
            Compression::ZIP16,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_shared_attributes(shared)
        .with_attributes(own))
}

/// UTF-8, as OpenEXR has it today; the crate's own conversion refuses all but Latin-1.
fn string(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
