//! What drivers compiled, kept from one process to the next: Vulkan's pipeline cache as a file.
//!
//! GPUs' drivers put machine code in it. Mesa's lavapipe (22.3.6 and 25.0.7) gives its 32 bytes of header
//! whatever it has compiled, and keeps its code in a cache of its own: there no file is written.
//!
//! One file serves one adapter under one driver and one set of shaders. Kernels that are baked for one scene
//! stay out of it, so that it does not grow with every scene; a file that has grown too large all the same
//! is deleted, and the next process starts a new one.

use super::guard::Guard;
use crate::cache::{Folder, Kind};
use crate::device::DeviceInfo;
use crate::panics::catch;
use crate::shader::library_hash;

/// Files of pipelines in the cache's folder.
const KIND: Kind = Kind {
    name: "pipelines",
    most: 8,
};

/// A file of every shared kernel with many strategies is far below this.
const MOST_BYTES: usize = 32 << 20;

/// A driver's pipelines, with the file they came from and go to.
#[derive(Debug)]
pub struct Kept {
    pipelines: wgpu::PipelineCache,
    file: File,
}

impl Kept {
    /// What an adapter needs for it; nothing where it has no such cache.
    pub fn features(adapter: &wgpu::Adapter) -> wgpu::Features {
        adapter.features() & wgpu::Features::PIPELINE_CACHE
    }

    /// The pipelines of earlier processes; none where the driver keeps none, or nothing is to be kept.
    pub fn open(guard: &Guard, adapter: &wgpu::Adapter, info: &DeviceInfo) -> Option<Self> {
        if Self::features(adapter).is_empty() {
            return None;
        }
        let adapter_key = wgpu::util::pipeline_cache_key(&adapter.get_info())?;
        let key = [&*info.name, &*info.driver, &*adapter_key, &*library_hash()].join("\n");
        let (mut file, kept) = File::open(Folder::of_user()?, key);
        let pipelines = create(guard, kept.as_deref())?;
        file.known = data(&pipelines).len();
        Some(Self { pipelines, file })
    }

    /// For the driver to look in, and to add to.
    pub fn pipelines(&self) -> &wgpu::PipelineCache {
        &self.pipelines
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        self.file.save(&data(&self.pipelines));
    }
}

/// A cache of what was kept, or an empty one where that is not for this device.
fn create(guard: &Guard, kept: Option<&[u8]>) -> Option<wgpu::PipelineCache> {
    let descriptor = wgpu::PipelineCacheDescriptor {
        label: Some("lampray"),
        data: kept,
        fallback: true,
    };
    let made = guard.scoped(|device| {
        // SAFETY: the data must be what `get_data` gave of such a cache. It is read from a folder that nobody
        // but the user writes to, behind a checksum over it and a key of adapter, driver and shaders;
        // wgpu and the driver look at their own headers after that.
        #[allow(unsafe_code)]
        unsafe {
            device.create_pipeline_cache(&descriptor)
        }
    });
    match (made, kept) {
        (Err(_), Some(_)) => create(guard, None),
        (made, _) => made.ok(),
    }
}

/// What the driver has; nothing where it says nothing, or is lost.
fn data(pipelines: &wgpu::PipelineCache) -> Vec<u8> {
    let data = catch(|| pipelines.get_data());
    data.ok().flatten().unwrap_or_default()
}

/// Where a cache's data is kept.
#[derive(Debug)]
struct File {
    folder: Folder,
    key: String,
    /// Bytes of what need not be written: what the file held, or a cache with nothing in it.
    known: usize,
}

impl File {
    /// A file with what it holds. What others may have written is not read: it goes to the driver.
    fn open(folder: Folder, key: String) -> (Self, Option<Vec<u8>>) {
        let kept = match folder.is_private() {
            true => folder.read(KIND, &key),
            false => None,
        };
        let kept = kept.filter(|data| data.len() <= MOST_BYTES);
        let known = kept.as_ref().map_or(0, Vec::len);
        (Self { folder, key, known }, kept)
    }

    /// Writes what is new; a driver that gives no more than it does of an empty cache keeps nothing.
    fn save(&mut self, data: &[u8]) {
        if data.len() > MOST_BYTES {
            self.folder.remove(KIND, &self.key);
        } else if !data.is_empty() && data.len() != self.known {
            self.folder.write(KIND, &self.key, data);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(shaders: &str) -> String {
        format!("adapter\n{shaders}")
    }

    fn opened(folder: &Folder, shaders: &str) -> (File, Option<Vec<u8>>) {
        File::open(folder.clone(), key(shaders))
    }

    /// A folder of the user's own, with one file in it.
    fn kept() -> (tempfile::TempDir, Folder) {
        let outer = tempfile::tempdir().unwrap();
        let folder = Folder::at(outer.path().join("cache"));
        let (mut file, nothing) = opened(&folder, "shaders");
        assert_eq!(nothing, None);
        file.known = b"header".len();
        file.save(b"header, and code");
        (outer, folder)
    }

    #[test]
    fn pipelines_come_back_for_the_same_shaders_alone() {
        let (_outer, folder) = kept();
        let (_, found) = opened(&folder, "shaders");
        assert_eq!(found.unwrap(), b"header, and code");
        assert_eq!(opened(&folder, "other shaders").1, None);
    }

    #[test]
    fn a_header_alone_is_not_written() {
        let outer = tempfile::tempdir().unwrap();
        let folder = Folder::at(outer.path().join("cache"));
        let (mut file, _) = opened(&folder, "shaders");
        file.known = b"header".len();
        file.save(b"header");
        file.save(b"");
        assert!(!folder.path().exists());
    }

    #[test]
    fn a_file_that_has_grown_too_large_goes() {
        let (_outer, folder) = kept();
        let (mut file, _) = opened(&folder, "shaders");
        file.save(&vec![0; MOST_BYTES + 1]);
        assert_eq!(opened(&folder, "shaders").1, None);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    /// On the first graphics device; where there is none nothing is handed to a driver.
    #[test]
    fn data_that_is_no_drivers_makes_an_empty_cache() {
        let adapters = crate::gpu::adapters();
        let Some((adapter, _)) = adapters.get(0) else {
            let required =
                std::env::var_os("LAMPRAY_REQUIRE_GPU").is_some_and(|value| value == "1");
            assert!(
                !required,
                "LAMPRAY_REQUIRE_GPU=1, and no graphics device was found"
            );
            eprintln!("NOT RUN on a GPU: data that is no driver's (no graphics device was found)");
            return;
        };
        let gpu = crate::gpu::Gpu::open(&adapters, 0).unwrap();
        if Kept::features(adapter).is_empty() {
            assert!(gpu.kept.is_none());
            return;
        }
        let empty = data(&create(&gpu.guard, None).unwrap());
        let mut damaged = empty.clone();
        damaged[20] ^= 1;
        for foreign in [b"no driver's".as_slice(), &empty[..40], &damaged] {
            let made = create(&gpu.guard, Some(foreign)).unwrap();
            assert_eq!(data(&made).len(), empty.len());
        }
        assert_eq!(data(&create(&gpu.guard, Some(&empty)).unwrap()), empty);
    }

    #[cfg(unix)]
    #[test]
    fn what_others_may_have_written_is_not_read() {
        use std::os::unix::fs::PermissionsExt;
        let (_outer, folder) = kept();
        let mode = std::fs::Permissions::from_mode;
        std::fs::set_permissions(folder.path(), mode(0o777)).unwrap();
        assert_eq!(opened(&folder, "shaders").1, None);
        std::fs::set_permissions(folder.path(), mode(0o755)).unwrap();
        assert!(opened(&folder, "shaders").1.is_some());
    }
}
