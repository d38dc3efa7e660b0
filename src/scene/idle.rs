//! Settings that change nothing beside others: legal, since a sweep crosses them, but perhaps not what was meant.

use super::Scene;
use crate::knobs::{
    InterruptionRule, InterruptionWeight, LightChoice, LightSampler, LightSource, LightStrategy,
    LightTest, LightWeight, Scatter, ScatterBound, Sequence, Settings,
};

impl Scene {
    /// What is set and changes nothing here, or less than it seems: a line each. Only values other than the preset's
    /// are looked at.
    pub fn notes(&self) -> Vec<String> {
        let usual = Settings::of(self.settings.preset);
        let all = [
            self.idle_light(&usual),
            self.idle_sources(),
            self.idle_numbers(&usual),
            self.idle_interruption(&usual),
        ];
        all.into_iter().flatten().collect()
    }

    /// How lamps are sampled, where they are not, or otherwise.
    fn idle_light(&self, usual: &Settings) -> Vec<String> {
        let (light, usual) = (&self.settings.light, &usual.light);
        let mut idle = Idle::default();
        let hit = light.strategy == LightStrategy::Hit;
        let unasked = "light.strategy = hit sends no shadow rays";
        let poles = [LightSampler::UniformAngles, LightSampler::InverseCosine];
        let solid_angle = light.weight == LightWeight::SolidAngle;
        let boxes = match light.boxes {
            LightSource::Sample => self.shining_boxes(),
            LightSource::Hit => 0,
        };
        let one_lamp = self.lamps().count() + boxes < 2;
        if hit {
            idle.say(light.sampler != usual.sampler, "light.sampler", unasked);
            idle.say(light.test != usual.test, "light.test", unasked);
            idle.say(light.choice != usual.choice, "light.choice", unasked);
            idle.say(light.pole != usual.pole, "light.pole", unasked);
            return idle.lines;
        }
        if light.pole != usual.pole && !poles.contains(&light.sampler) {
            let why = format!("light.sampler = {} has no poles", light.sampler);
            idle.say(true, "light.pole", &why);
        }
        let why = "there are no two lamps to choose from";
        idle.say(
            light.choice != LightChoice::All && one_lamp,
            "light.choice",
            why,
        );
        let why = "light.weight = solid-angle asks for the body, whatever the point";
        idle.say(
            solid_angle && light.test != LightTest::Point,
            "light.test",
            why,
        );
        let radius = light.weight_radius.filter(|_| !solid_angle);
        let why = "only light.weight = solid-angle has a radius";
        idle.say(radius.is_some(), "light.weight_radius", why);
        idle.lines
    }

    /// Shadow rays to boxes and background that nothing sends or nothing answers.
    fn idle_sources(&self) -> Vec<String> {
        let light = &self.settings.light;
        let no_box = self.shining_boxes() == 0;
        let sources = [
            ("light.boxes", light.boxes, no_box, "no box shines"),
            (
                "light.background",
                light.background,
                self.background.max_element() == 0.0,
                "the background is black",
            ),
        ];
        let mut idle = Idle::default();
        for (path, source, dark, why) in sources {
            if source != LightSource::Sample {
                continue;
            }
            let why = match light.strategy {
                LightStrategy::Hit => "light.strategy = hit sends no shadow rays",
                _ if dark => why,
                _ => continue,
            };
            idle.say(true, path, why);
        }
        idle.lines
    }

    fn shining_boxes(&self) -> usize {
        let shines = |material: usize| self.materials[material].emits();
        self.boxes.iter().filter(|one| shines(one.material)).count()
    }

    /// What numbers are drawn, and what directions are made of them.
    fn idle_numbers(&self, usual: &Settings) -> Vec<String> {
        let settings = &self.settings;
        let mut idle = Idle::default();
        let set = settings.render.randomisations != usual.render.randomisations;
        let independent = settings.render.sequence == Sequence::Independent;
        let why = "render.sequence = independent has no point sets";
        idle.say(set && independent, "render.randomisations", why);
        if let Some(length) = settings.render.randomisation().filter(|_| set) {
            let (sets, wanted) = (
                settings.render.samples / length,
                settings.render.randomisations,
            );
            if sets < wanted {
                idle.lines.push(format!(
                    "render.randomisations = {wanted} is more than render.samples = {} allow: sets have {length} samples at least, so there are {sets}",
                    settings.render.samples
                ));
            }
        }
        let set = settings.scatter.diffuse != usual.scatter.diffuse;
        let why = "no shape is diffuse";
        idle.say(
            set && !self.scatters(Scatter::Diffuse),
            "scatter.diffuse",
            why,
        );
        let set = settings.scatter.bound != usual.scatter.bound;
        let clamps = settings.scatter.bound == ScatterBound::Clamp;
        let none = !self.scatters(Scatter::Directional);
        idle.say(
            set && clamps && none,
            "scatter.bound",
            "no shape is directional",
        );
        idle.lines
    }

    /// Whether a shape's surface is of that kind.
    pub(super) fn scatters(&self, scatter: Scatter) -> bool {
        let materials = self.materials.iter().zip(self.used_materials());
        let mut used = materials.filter(|(_, used)| *used);
        used.any(|(material, _)| material.scatter == scatter)
    }

    fn idle_interruption(&self, usual: &Settings) -> Vec<String> {
        let (own, usual) = (&self.settings.interruption, &usual.interruption);
        let mut idle = Idle::default();
        let efficiency = own.rule == InterruptionRule::Efficiency;
        let why = "only interruption.rule = efficiency splits paths";
        idle.say(
            own.split != usual.split && !efficiency,
            "interruption.split",
            why,
        );
        let why = "interruption.rule = none interrupts nothing";
        let none = own.rule == InterruptionRule::None;
        idle.say(none && own.start != usual.start, "interruption.start", why);
        idle.say(none && own.order != usual.order, "interruption.order", why);
        let late = own.start != usual.start && own.start >= self.settings.render.max_bounces;
        let unreached = format!(
            "render.max_bounces = {}: no path comes to that hit",
            self.settings.render.max_bounces
        );
        idle.say(!none && late, "interruption.start", &unreached);
        let literal = own.weight == InterruptionWeight::Literal && own.weight != usual.weight;
        idle.say(none && literal, "interruption.weight", why);
        if efficiency && own.start > 0 {
            idle.lines.push(format!(
                "interruption.rule = efficiency asks no hit before number interruption.start = {}, and the first ones pay most; set interruption.start=0",
                own.start
            ));
        }
        idle.lines
    }
}

/// Lines on what is set in vain.
#[derive(Default)]
struct Idle {
    lines: Vec<String>,
}

impl Idle {
    fn say(&mut self, holds: bool, path: &str, why: &str) {
        if holds {
            self.lines
                .push(format!("{path} changes nothing here: {why}"));
        }
    }
}
