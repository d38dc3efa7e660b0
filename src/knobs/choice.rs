//! Knobs that take one of a few names: the Rust enum is the only place where the names and the
//! numbers that the shaders see are written down.

/// A knob type with a fixed list of names.
pub trait Choice: Copy + Eq + Sized + 'static {
    /// Every value, in the order of its number.
    const ALL: &'static [Self];
    /// Every name, in the order of its number.
    const NAMES: &'static [&'static str];
    /// The prefix of the WGSL constants, for example `LIGHT_SAMPLER`.
    const WGSL: &'static str;

    /// The number that the shaders compare with.
    fn index(self) -> u32;

    /// The name that scene files, `--set` and records use.
    fn name(self) -> &'static str {
        Self::NAMES[self.index() as usize]
    }

    /// The value with this name, if there is one.
    fn from_name(name: &str) -> Option<Self> {
        let index = Self::NAMES.iter().position(|known| *known == name)?;
        Some(Self::ALL[index])
    }

    /// One WGSL constant a value: `const LIGHT_SAMPLER_CONE: u32 = 3u;`.
    fn wgsl_constants() -> String {
        let line = |(number, name): (usize, &&str)| {
            let name = name.to_uppercase().replace('-', "_");
            format!("const {}_{name}: u32 = {number}u;\n", Self::WGSL)
        };
        Self::NAMES.iter().enumerate().map(line).collect()
    }
}

macro_rules! choice {
    ($(#[$doc:meta])* $type:ident, $wgsl:literal { $($(#[$item_doc:meta])* $item:ident = $name:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type { $($(#[$item_doc])* $item,)+ }

        impl Choice for $type {
            const ALL: &'static [Self] = &[$(Self::$item,)+];
            const NAMES: &'static [&'static str] = &[$($name,)+];
            const WGSL: &'static str = $wgsl;
            fn index(self) -> u32 { self as u32 }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use choice;

choice! {
    /// How a surface sends light on.
    Scatter, "SURFACE" {
        /// Lambert: evenly bright from everywhere.
        Diffuse = "diffuse",
        /// A half-normal angle around the mirror direction (paper, section 2.1).
        Directional = "directional",
        /// The mirror direction alone.
        Mirror = "mirror",
        /// A mirror of small facets turned at random (GGX).
        Rough = "rough",
        /// Clear glass: reflection and refraction by Fresnel's equations.
        Glass = "glass",
    }
}

choice! {
    /// Where in a pixel a path starts.
    Filter, "FILTER" {
        /// Evenly over the pixel's own square.
        Box = "box",
        /// A tent two pixels wide around the pixel's lower left corner, as the paper's base code has it.
        Tent = "tent",
    }
}

choice! {
    /// The curve from linear light to PNG values.
    Encoding, "ENCODING" {
        /// IEC 61966-2-1.
        Srgb = "srgb",
        /// The power 1/2.2, rounded down, as the paper's base code has it.
        Gamma22 = "gamma22",
    }
}

choice! {
    /// How a point on a spherical lamp is drawn (paper, section 2.2; cone: Shirley, Wang and Zimmerman 1996).
    LightSampler, "LIGHT_SAMPLER" {
        /// Case 1: both angles uniform; points crowd at the poles.
        UniformAngles = "uniform-angles",
        /// Case 2: the polar angle by the inverse cosine; uniform by area.
        InverseCosine = "inverse-cosine",
        /// Case 3: three normal numbers, made a unit vector; uniform by area.
        Gaussian = "gaussian",
        /// Uniform over the cone of directions under which the lamp is seen.
        Cone = "cone",
        /// Uniform by area over the half that the receiver can see.
        FacingCap = "facing-cap",
        /// Case 1 with its pole at the receiver, on the half that it can see.
        FacingAngles = "facing-angles",
        /// Uniform by projected solid angle: each direction counts alike for a matt receiver.
        ProjectedCap = "projected-cap",
    }
}

choice! {
    /// When a drawn lamp point counts.
    LightTest, "LIGHT_TEST" {
        /// When the point itself is seen.
        Point = "point",
        /// When the lamp is the first body in its direction, as in the base code.
        Object = "object",
    }
}

choice! {
    /// What a drawn lamp point is weighted by.
    LightWeight, "LIGHT_WEIGHT" {
        /// One over the sampler's true density.
        Pdf = "pdf",
        /// The base code's solid angle of a cone, measured to the drawn point.
        SolidAngle = "solid-angle",
    }
}

choice! {
    /// Which rays find the lamps.
    LightStrategy, "LIGHT_STRATEGY" {
        /// Shadow rays only.
        Sample = "sample",
        /// Scattered rays that hit a lamp only.
        Hit = "hit",
        /// Both, weighted by the power heuristic (Veach 1997).
        Mis = "mis",
    }
}

choice! {
    /// Which lamps a hit sends shadow rays to.
    LightChoice, "LIGHT_CHOICE" {
        /// To every lamp, as in the paper.
        All = "all",
        /// To one, each as likely as any other.
        Uniform = "uniform",
        /// To one, by what the lamps send out (alias table: Walker 1977, Vose 1991).
        Power = "power",
        /// To one, by a tree of lamps walked from where the light arrives (Conty Estevez and Kulla 2018).
        Tree = "tree",
    }
}

choice! {
    /// Which rays find what shines and is no spherical lamp.
    LightSource, "LIGHT_SOURCE" {
        /// Scattered rays alone.
        Hit = "hit",
        /// Shadow rays too, by the light strategy.
        Sample = "sample",
    }
}

choice! {
    /// What surfaces do with direct light.
    LightDirect, "LIGHT_DIRECT" {
        /// What their scattering says.
        Bsdf = "bsdf",
        /// The paper: every surface is lit as if it were diffuse, and emission counts at the camera's hit only.
        Lambert = "lambert",
    }
}

choice! {
    /// How diffuse surfaces draw directions.
    ScatterDiffuse, "SCATTER_DIFFUSE" {
        /// By the cosine.
        Cosine = "cosine",
        /// Evenly over the half sphere, weighted by twice the cosine.
        Uniform = "uniform",
    }
}

choice! {
    /// What keeps the angle of directional scattering under a right angle.
    ScatterBound, "SCATTER_BOUND" {
        /// The half-normal law cut off at a right angle.
        Truncate = "truncate",
        /// The smaller of the drawn angle and a right angle.
        Clamp = "clamp",
    }
}

choice! {
    /// What the probability of going on is (paper, section 2.3).
    InterruptionRule, "INTERRUPTION_RULE" {
        /// Always one.
        None = "none",
        /// The material's own threshold.
        Survival = "survival",
        /// The largest albedo channel.
        Albedo = "albedo",
        /// The largest channel of what the next ray would carry, at most 0.95.
        Throughput = "throughput",
        /// As many rays as are worth their cost (Rath et al. 2022): paths are thinned out or split.
        Efficiency = "efficiency",
    }
}

choice! {
    /// What happens to the weight of paths that go on.
    InterruptionWeight, "INTERRUPTION_WEIGHT" {
        /// Divided by the probability: unbiased.
        Compensated = "compensated",
        /// Left alone, as published.
        Literal = "literal",
    }
}

choice! {
    /// Where in a hit the interruption test stands.
    InterruptionOrder, "INTERRUPTION_ORDER" {
        /// Direct light is added first.
        AfterDirect = "after-direct",
        /// A path that is interrupted loses this hit's direct light too.
        BeforeDirect = "before-direct",
    }
}

choice! {
    /// How the numbers of a pixel's samples fill their space.
    Sequence, "SEQUENCE" {
        /// Each sample by itself.
        Independent = "independent",
        /// One in each cell of a grid, pair by pair of dimensions: correlated multi-jittered (Kensler 2013).
        Stratified = "stratified",
        /// Sobol's first two dimensions with Owen's scrambling, anew for each pair of dimensions (Burley 2020).
        Sobol = "sobol",
        /// The same points, dealt to neighbouring pixels so that their errors cancel (Ahmed and Wonka 2020).
        BlueNoise = "blue-noise",
    }
}

choice! {
    /// How rays find bodies; every way finds the same.
    RenderKernel, "RENDER_KERNEL" {
        /// `bvh` for many bodies; for few `baked` where the work pays for compiling it, else `general`.
        Auto = "auto",
        /// One body after the other.
        General = "general",
        /// By a bounding volume hierarchy.
        Bvh = "bvh",
        /// One body after the other, in code that is printed and compiled for the scene.
        Baked = "baked",
    }
}

choice! {
    /// A named set of sampling knobs.
    Preset, "PRESET" {
        /// The rules of the paper's base code.
        Montelight = "montelight",
        /// The paper, read literally.
        Paper = "paper",
        /// The paper's samplers with unbiased weights.
        Corrected = "corrected",
        /// The best samplers there are here.
        Reference = "reference",
    }
}
