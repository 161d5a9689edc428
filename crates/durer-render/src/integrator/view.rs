//! The colours of points of the picture, each from one ray or from the mean of many.

use super::whitted::Whitted;
use crate::camera::{Camera, MeshRays, RenderLens, Samples, Sampling};
use crate::sampler::Place;
use durer_scene::Rgb;

/// The most rays that are traced together.
const TOGETHER: usize = 1 << 16;

/// The number of further rays of a point after those that were not enough.
const MORE: u32 = 8;

impl Whitted<'_> {
    /// Computes the colours of some points of a picture of the given size, in order. Returns `None`
    /// if the work was cancelled.
    pub(crate) fn look(
        &mut self,
        camera: &Camera,
        picture: (u32, u32),
        places: &[Place],
        colours: &mut Vec<Rgb>,
    ) -> Option<()> {
        match camera.sampling() {
            Sampling::Once => self.look_once(camera, picture, (places, &[]), colours),
            Sampling::Faces(mesh) => self.look_from_faces(camera, mesh, picture, places, colours),
            Sampling::Lens(lens) => self.look_through_lens(camera, lens, picture, places, colours),
        }
    }

    /// For each point, the mean of the rays from all its faces.
    fn look_from_faces(
        &mut self,
        camera: &Camera,
        mesh: &MeshRays,
        picture: (u32, u32),
        places: &[Place],
        colours: &mut Vec<Rgb>,
    ) -> Option<()> {
        let mut sums = vec![Samples::default(); places.len()];
        let mut seen = Vec::new();
        for number in 0..mesh.rays_per_place() {
            let has_face = |place: &Place| mesh.ray(place.x, place.y, number, picture).is_some();
            let shot: Vec<usize> = (0..places.len()).filter(|&i| has_face(&places[i])).collect();
            let some: Vec<Place> = shot.iter().map(|&i| places[i]).collect();
            self.look_once(camera, picture, (&some, &vec![number; some.len()]), &mut seen)?;
            for (i, &colour) in shot.into_iter().zip(&seen) {
                sums[i].add(colour);
            }
        }
        colours.clear();
        colours.extend(sums.iter().map(Samples::mean));
        Some(())
    }

    /// For each point, the mean of as many rays as the lens needs.
    fn look_through_lens(
        &mut self,
        camera: &Camera,
        lens: &RenderLens,
        picture: (u32, u32),
        places: &[Place],
        colours: &mut Vec<Rgb>,
    ) -> Option<()> {
        let mut means = Vec::with_capacity(places.len());
        let (mut some, mut numbers, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        for places in places.chunks(TOGETHER / 64) {
            let mut sums = vec![Samples::default(); places.len()];
            let mut open: Vec<usize> = (0..places.len()).collect();
            let mut next = 0;
            while !open.is_empty() && next < lens.most() {
                // All unfinished points have had the same number of rays.
                let more = if next < lens.fewest() { (lens.fewest() - next).min(64) } else { MORE };
                let until = next.saturating_add(more).min(lens.most());
                some.clear();
                numbers.clear();
                for &i in &open {
                    some.extend((next..until).map(|_| places[i]));
                    numbers.extend(next..until);
                }
                self.look_once(camera, picture, (&some, &numbers), &mut seen)?;
                for (&i, colours) in open.iter().zip(seen.chunks((until - next) as usize)) {
                    colours.iter().for_each(|&colour| sums[i].add(colour));
                }
                open.retain(|&i| !lens.is_enough(&sums[i]));
                next = until;
            }
            means.extend(sums.iter().map(Samples::mean));
        }
        *colours = means;
        Some(())
    }
}
