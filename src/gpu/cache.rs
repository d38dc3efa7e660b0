//! The pipelines that are kept: all that serve many scenes, and the last few that serve one.

use crate::pack::Strategy;
use crate::shader::{Kernel, SceneArrays};
use std::collections::{HashMap, VecDeque};

/// What tells a pipeline from all others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    pub kernel: Kernel,
    pub strategy: Strategy,
    /// Of the scene, in kernels that trace.
    pub arrays: Option<SceneArrays>,
    /// The printed source's hash, in a kernel for one scene.
    pub baked: Option<[u8; 32]>,
}

/// Pipelines for one scene each that are kept: a device that renders a few scenes in turn compiles none of
/// them twice, and one that goes through many does not grow.
const MOST_BAKED: usize = 4;

#[derive(Debug)]
pub struct Cache<V> {
    shared: HashMap<Key, V>,
    /// The last used last.
    baked: VecDeque<(Key, V)>,
}

impl<V: Clone> Cache<V> {
    pub fn new() -> Self {
        Self {
            shared: HashMap::new(),
            baked: VecDeque::new(),
        }
    }

    pub fn get(&mut self, key: &Key) -> Option<V> {
        if key.baked.is_none() {
            return self.shared.get(key).cloned();
        }
        let place = self.baked.iter().position(|(known, _)| known == key)?;
        let entry = self.baked.remove(place)?;
        self.baked.push_back(entry);
        self.baked.back().map(|(_, value)| value.clone())
    }

    pub fn insert(&mut self, key: Key, value: V) {
        if key.baked.is_none() {
            self.shared.insert(key, value);
            return;
        }
        if self.baked.len() == MOST_BAKED {
            self.baked.pop_front();
        }
        self.baked.push_back((key, value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::Packed;
    use crate::scene::Scene;

    fn key(baked: Option<u8>) -> Key {
        let text = "version = 1\ncamera = { position = [0, 0, 0], look_at = [0, 0, -1] }\n";
        let scene = Scene::parse("a.toml", text, &[]).unwrap();
        Key {
            kernel: Kernel::Trace,
            strategy: Packed::new(&scene).strategy,
            arrays: None,
            baked: baked.map(|byte| [byte; 32]),
        }
    }

    #[test]
    fn a_few_scenes_are_kept_and_the_rest_always() {
        let mut cache = Cache::new();
        cache.insert(key(None), 255);
        for scene in 0..MOST_BAKED as u8 {
            cache.insert(key(Some(scene)), scene);
        }
        // The first is used again, so that the second is the oldest.
        assert_eq!(cache.get(&key(Some(0))), Some(0));
        cache.insert(key(Some(100)), 100);
        assert_eq!(cache.get(&key(Some(1))), None);
        assert_eq!(cache.get(&key(Some(0))), Some(0));
        for scene in 0..100 {
            cache.insert(key(Some(scene)), scene);
        }
        assert_eq!(cache.baked.len(), MOST_BAKED);
        assert_eq!(cache.get(&key(Some(99))), Some(99));
        assert_eq!(cache.get(&key(None)), Some(255));
    }
}
