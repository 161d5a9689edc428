//! The words of POV-Ray's language that durer does not support yet. A word that becomes supported
//! must be removed from this list.

use crate::keywords::Keyword;

/// Whether `keyword` belongs to a feature that is not supported yet, wherever it stands.
pub(crate) fn is_unsupported(keyword: Keyword) -> bool {
    use Keyword::*;
    matches!(
        keyword,
        AaLevel
            | AaThreshold
            | Absorption
            | Alpha
            | AlwaysSample
            | Autostop
            | Brightness
            | Collect
            | Composite
            | Count
            | Density
            | DensityMap
            | Eccentricity
            | ErrorBound
            | ExpandThresholds
            | Extinction
            | Gather
            | GrayThreshold
            | Iff
            | Importance
            | InteriorTexture
            | Intervals
            | LoadFile
            | LowErrorFactor
            | MaxSample
            | MaximumReuse
            | Method
            | MinimumReuse
            | NearestCount
            | PassThrough
            | PretraceEnd
            | PretraceStart
            | Prod
            | Pwr
            | Ratio
            | Reciprocal
            | RecursionLimit
            | Samples
            | SaveFile
            | Scattering
            | Sint16be
            | Sint16le
            | Sint32be
            | Sint32le
            | Sint8
            | Size
            | Spacing
            | Sum
            | Target
            | Translucency
            | Uint16be
            | Uint16le
            | Uint8
            | Width
            | Xyz
    )
}
