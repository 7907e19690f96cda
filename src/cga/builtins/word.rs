//! Every keyword and selector that may stand as an argument or select a component (reference 3.5-3.7, appendix B).
//!
//! In: a word as written. Out: a [`Word`].

macro_rules! words {
    ($($variant:ident $text:literal)*) => {
        /// A keyword in argument or selector position.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Word { $($variant),* }

        impl Word {
            pub const ALL: &'static [Word] = &[$(Word::$variant),*];

            /// As written in a rule file.
            pub fn text(self) -> &'static str {
                match self { $(Word::$variant => $text),* }
            }

            pub fn from_text(text: &str) -> Option<Word> {
                match text { $($text => Some(Word::$variant),)* _ => None }
            }
        }
    };
}

words! {
    Front "front" Back "back" Right "right" Left "left" Top "top" Bottom "bottom" Side "side"
    ObjectFront "object.front" ObjectBack "object.back" ObjectRight "object.right" ObjectLeft "object.left"
    ObjectTop "object.top" ObjectBottom "object.bottom" ObjectSide "object.side"
    WorldSouth "world.south" WorldNorth "world.north" WorldEast "world.east" WorldWest "world.west"
    WorldUp "world.up" WorldDown "world.down" WorldSide "world.side"
    Vertical "vertical" Aslant "aslant" Nutant "nutant" Horizontal "horizontal"
    All "all" Border "border" Inside "inside" Eave "eave" Hip "hip" Valley "valley" Ridge "ridge"
    StreetFront "street.front" StreetBack "street.back" StreetLeft "street.left" StreetRight "street.right"
    StreetSide "street.side" LegacyStreetSide "streetSide" LegacyNoStreetSide "noStreetSide"
    UvLeft "uv.left" UvRight "uv.right" UvBottom "uv.bottom" UvTop "uv.top"
    UvUMin "uv.uMin" UvUMax "uv.uMax" UvVMin "uv.vMin" UvVMax "uv.vMax"
    Remainder "remainder" Shape "shape"
    X "x" Y "y" Z "z" U "u" V "v" Xy "xy" Xz "xz" Yz "yz" Yx "yx" Zx "zx" Zy "zy" Xyz "xyz" Yzx "yzx" Zxy "zxy"
    WorldX "world.x" WorldY "world.y" WorldZ "world.z" WorldXyz "world.xyz"
    ObjectX "object.x" ObjectY "object.y" ObjectZ "object.z" ObjectXyz "object.xyz"
    ScopeXy "scope.xy" ScopeXz "scope.xz" ScopeYx "scope.yx" ScopeYz "scope.yz" ScopeZx "scope.zx" ScopeZy "scope.zy"
    WorldXy "world.xy" WorldXz "world.xz" WorldYx "world.yx" WorldYz "world.yz" WorldZx "world.zx" WorldZy "world.zy"
    F "f" E "e" Fe "fe" Fv "fv" G "g" M "m" H "h"
    YUp "yUp" ZUp "zUp" NoAlign "noAlign" Adjust "adjust" NoAdjust "noAdjust"
    UvSpace "uvSpace" UnitSpace "unitSpace"
    WorldLowest "world.lowest" Largest "largest" Longest "longest" Any "any" Auto "auto"
    Vertices "vertices" Edges "edges" Faces "faces"
    Normal "normal" FaceNormal "face.normal" VertexNormal "vertex.normal" WorldUpFlatTop "world.up.flatTop"
    Append "append" Unify "unify" Recompose "recompose"
    Scope "scope" Pivot "pivot" Object "object" World "world" Edge "edge" ScopeY "scope.y"
    Uv "uv" UvUniform "uvUniform" SeparatePerFace "separatePerFace" CollectiveAllFaces "collectiveAllFaces"
    ScopeOrigin "scopeOrigin" ScopeCenter "scopeCenter" Abs "abs" Rel "rel"
    ByAngle "byAngle" ByHeight "byHeight" Along "along" Across "across"
    Geometry "geometry" Used "used" Changed "changed"
    Surface "surface" Volume "volume" Uniform "uniform" Gaussian "gaussian" Center "center"
    Hard "hard" Soft "soft" Conform "conform"
    AlignSizeAndPosition "alignSizeAndPosition" KeepSizeAndPosition "keepSizeAndPosition"
    KeepSizeAlignPosition "keepSizeAlignPosition" AlignPosition "alignPosition" KeepPosition "keepPosition"
    NumericalCleanup "numericalCleanup" NoCleanup "noCleanup"
    MaxSlope "maxSlope" Azimuth "azimuth" Zenith "zenith"
    Sx "sx" Sy "sy" Sz "sz" Tx "tx" Ty "ty" Tz "tz"
    Intra "intra" Inter "inter" Pos "pos" Orient "orient"
    Northernmost "world.northernmost" Southernmost "world.southernmost" Easternmost "world.easternmost"
    Westernmost "world.westernmost" Highest "world.highest"
    AreaLargest "area.largest" AreaSmallest "area.smallest"
    GeoX "X" GeoY "Y" Longitude "lon" Latitude "lat"
    Swap "swap"
}
