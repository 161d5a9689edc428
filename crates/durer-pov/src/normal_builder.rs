//! The normal builder: turns the reader's perturbed normals into scene data.

use durer_scene as scene;

use crate::diagnostics::{Place, Result};
use crate::keywords::Keyword;
use crate::scene_builder::placement;
use crate::texture::{Normal, NormalKind, Pattern, PatternKind};
use crate::texture_builder::{pattern_of, value_of, warps_of};

/// Converts a normal; `None` if it perturbs nothing.
pub(crate) fn normal(own: &Normal, at: Place) -> Result<Option<scene::Normal>> {
    let Some(kind) = &own.kind else { return Ok(None) };
    let kind = match kind {
        NormalKind::Pattern(kind) => kind.clone(),
        // Only its warps are used.
        NormalKind::Facets(_) | NormalKind::NormalFacets(_) => PatternKind::Average,
    };
    let pattern = Pattern { kind, modifiers: own.modifiers.clone() };
    let body = match (&own.normals, push_of(own)) {
        (Some(map), _) => scene::NormalBody::Normals(Box::new(pattern_of(
            &pattern,
            map,
            at,
            |part| Ok(normal(part, at)?.unwrap_or_else(level)),
            Normal::blended,
        )?)),
        // A slope map has no effect on them (a fact of the language).
        (None, Some(push)) => {
            // Facets have an amount of their own.
            let is_facets = matches!(push, scene::Push::Facets(_) | scene::Push::NormalFacets(_));
            let amount = if is_facets { 1.0 } else { own.amount };
            scene::NormalBody::Push { warps: warps_of(&pattern, at)?, push, amount }
        }
        (None, _) if pattern.kind == PatternKind::Average => return Ok(None),
        (None, _) if own.is_bump_map && own.slopes.is_none() => {
            let PatternKind::Ramp(ramp, _) = &pattern.kind else { return Ok(None) };
            let scene::Ramp::Image(map, value) = &**ramp else { return Ok(None) };
            let warps = warps_of(&pattern, at)?;
            scene::NormalBody::Picture { warps, map: map.clone(), value: *value, amount: own.amount }
        }
        (None, _) => scene::NormalBody::Height(Box::new(scene::Height {
            warps: warps_of(&pattern, at)?,
            value: value_of(&pattern, at)?,
            slopes: own.slopes.as_ref().map_or_else(Vec::new, |map| map.entries.clone()),
            amount: own.amount,
            accuracy: own.accuracy,
        })),
    };
    let turn = own.modifiers.turn.as_deref().map(|turn| placement(turn, at)).transpose()?;
    let placement = placement(&own.modifiers.place, at)?;
    let (keeps_slope, on_chart) = (own.keeps_slope, own.modifiers.on_chart);
    Ok(Some(scene::Normal { body, placement, keeps_slope, on_chart, turn }))
}

/// A normal that perturbs nothing.
fn level() -> scene::Normal {
    let body = scene::NormalBody::Push { warps: Vec::new(), push: scene::Push::Bumps, amount: 0.0 };
    scene::Normal {
        body,
        placement: scene::Placement::IDENTITY,
        keeps_slope: false,
        on_chart: false,
        turn: None,
    }
}

/// The vector that a normal adds, for the patterns that perturb normals in their own way.
fn push_of(own: &Normal) -> Option<scene::Push> {
    let ripples = |waves| {
        let (frequency, phase) = (own.modifiers.frequency, own.modifiers.phase);
        scene::Push::Ripples(scene::Ripples { waves, frequency, phase })
    };
    let kind = match own.kind.as_ref()? {
        NormalKind::Facets(size) => return Some(scene::Push::Facets(*size)),
        NormalKind::NormalFacets(width) => return Some(scene::Push::NormalFacets(*width)),
        NormalKind::Pattern(kind) => kind,
    };
    match kind {
        PatternKind::Written(Keyword::Bumps, _) => Some(scene::Push::Bumps),
        PatternKind::Written(Keyword::Dents, _) => {
            Some(scene::Push::Dents { generator: own.modifiers.turbulence.generator })
        }
        PatternKind::Written(Keyword::Wrinkles, _) => Some(scene::Push::Wrinkles),
        PatternKind::Written(Keyword::Ripples, _) => Some(ripples(false)),
        PatternKind::Written(Keyword::Waves, _) => Some(ripples(true)),
        PatternKind::Ramp(ramp, _) => match **ramp {
            scene::Ramp::Quilted(bottom, top) => Some(scene::Push::Quilted(bottom, top)),
            _ => None,
        },
        _ => None,
    }
}
