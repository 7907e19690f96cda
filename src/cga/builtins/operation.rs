//! In: a name in operation position. Out: an [`Operation`] with its overloads and status.
//!
//! Operations that take a block (`split`, `comp`, `setback`, ...) are here with the arguments before the block.
//! To support an operation in the interpreter, change its row's `NotYet` to `Evaluated`.

use super::Status;
use super::Status::Evaluated;

macro_rules! operations {
    ($($variant:ident $name:literal $status:ident [$($signature:literal),*])*) => {
        /// A built-in operation.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Operation { $($variant),* }

        impl Operation {
            pub const ALL: &'static [Operation] = &[$(Operation::$variant),*];

            pub fn name(self) -> &'static str {
                match self { $(Operation::$variant => $name),* }
            }

            pub fn from_name(name: &str) -> Option<Operation> {
                match name { $($name => Some(Operation::$variant),)* _ => None }
            }

            /// The overloads, as [`super::Signature`] texts.
            pub fn signatures(self) -> &'static [&'static str] {
                match self { $(Operation::$variant => &[$($signature),*]),* }
            }

            pub fn status(self) -> Status {
                match self { $(Operation::$variant => $status),* }
            }
        }
    };
}

operations! {
    AlignScopeToAxes "alignScopeToAxes" Evaluated ["{x y z world.x world.y world.z world.xyz object.x object.y object.z object.xyz}?"]
    AlignScopeToGeometry "alignScopeToGeometry" Evaluated [
        "{yUp zUp} F{world.lowest largest any} F{world.lowest longest}", "{yUp zUp} F{auto}"
    ]
    AlignScopeToGeometryBBox "alignScopeToGeometryBBox" Evaluated ["{xy yx xz zx yz zy}"]
    Center "center" Evaluated ["{x y z xy xz yz xyz}"]
    CleanupGeometry "cleanupGeometry" Evaluated ["{vertices edges faces all} F"]
    Color "color" Evaluated ["S", "F F F F?"]
    Comp "comp" Evaluated ["{f e fe v fv g m h} {zUp noAlign}?"]
    Convexify "convexify" Evaluated ["F?"]
    CopyUv "copyUV" Evaluated ["F F"]
    DeleteHoles "deleteHoles" Evaluated [""]
    DeleteTags "deleteTags" Evaluated ["S? {all faces edges vertices}?"]
    DeleteUv "deleteUV" Evaluated ["F"]
    Envelope "envelope" Evaluated [
        "{normal world.up} F F F", "{normal world.up} F F F F F", "{normal world.up} F F F F F F F",
        "{normal world.up} F F F F F F F F F", "{normal world.up} F F[] F[]",
        "F F F", "F F F F F", "F F F F F F F", "F F F F F F F F F"
    ]
    Extrude "extrude" Evaluated [
        "F", "{face.normal vertex.normal world.up world.up.flatTop x y z world.x world.y world.z} F"
    ]
    Footprint "footprint" Evaluated [""]
    Insert "i" Evaluated [
        "S {yUp zUp}? {alignSizeAndPosition keepSizeAndPosition keepSizeAlignPosition}? {numericalCleanup noCleanup}?"
    ]
    Inline "inline" Evaluated ["{append unify recompose}?"]
    InnerRect "innerRect" Evaluated [""]
    InnerRectangle "innerRectangle" Evaluated ["{scope edge}"]
    InsertAlongUv "insertAlongUV" Evaluated ["F S F {scope.y vertex.normal}? {alignPosition keepPosition}?"]
    Intersect "intersect" Evaluated [""]
    Label "label" Evaluated ["S"]
    Mirror "mirror" Evaluated ["B B B"]
    MirrorScope "mirrorScope" Evaluated ["B B B"]
    Modify "modify" Evaluated ["{f e fe v fv g m h} {zUp noAlign}?"]
    NormalizeUv "normalizeUV" Evaluated ["F {uv uvUniform u v} {separatePerFace collectiveAllFaces}"]
    Offset "offset" Evaluated ["F {all inside border}?"]
    PrimitiveCone "primitiveCone" Evaluated ["F?", "F F F"]
    PrimitiveCube "primitiveCube" Evaluated ["", "F F F"]
    PrimitiveCylinder "primitiveCylinder" Evaluated ["F?", "F F F"]
    PrimitiveDisk "primitiveDisk" Evaluated ["F? F?"]
    PrimitiveQuad "primitiveQuad" Evaluated ["", "F F"]
    PrimitiveSphere "primitiveSphere" Evaluated ["", "F F F?"]
    Print "print" Evaluated ["X"]
    ProjectUv "projectUV" Evaluated ["F"]
    R "r" Evaluated ["{scopeOrigin scopeCenter} F F F", "F F F"]
    Rectify "rectify" Evaluated ["F"]
    ReduceGeometry "reduceGeometry" Evaluated ["F"]
    Report "report" Evaluated ["S X"]
    ResetGeometry "resetGeometry" Evaluated [""]
    ResetMaterial "resetMaterial" Evaluated ["{shape geometry all}?"]
    ReverseNormals "reverseNormals" Evaluated [""]
    RoofGable "roofGable" Evaluated ["F F? F? B? F?", "{byAngle byHeight} F F? F? B? F?"]
    RoofHip "roofHip" Evaluated ["F F? B?", "{byAngle byHeight} F F? B?"]
    RoofPyramid "roofPyramid" Evaluated ["F", "{byAngle byHeight} F"]
    RoofRidge "roofRidge" Evaluated ["{byAngle byHeight} F"]
    RoofShed "roofShed" Evaluated ["F F?", "{byAngle byHeight} F F?"]
    Rotate "rotate" Evaluated ["{abs rel} {scope pivot object world} F F F"]
    RotateScope "rotateScope" Evaluated ["F F F"]
    RotateUv "rotateUV" Evaluated ["F F"]
    S "s" Evaluated ["F' F' F'"]
    ScaleUv "scaleUV" Evaluated ["F F F"]
    Scatter "scatter" Evaluated [
        "{surface volume scope} F {uniform gaussian}",
        "{surface volume scope} F {gaussian} {center front back left right top bottom} F'"
    ]
    Set "set" Evaluated ["X X"]
    SetMaterial "setMaterial" Evaluated ["S[]"]
    SetNormals "setNormals" Evaluated ["{hard soft auto conform}"]
    SetPivot "setPivot" Evaluated ["{xyz yzx zxy yUp zUp} F"]
    SetTagsFromEdgeAttrs "setTagsFromEdgeAttrs" Evaluated [""]
    Setback "setback" Evaluated ["F F?", "F[] F?"]
    SetbackPerEdge "setbackPerEdge" Evaluated ["F F?"]
    SetbackToArea "setbackToArea" Evaluated ["F F?", "F F[] F?", "F F[] F[] F?"]
    // With five arguments the last one is the uw factor (an old overload).
    SetupProjection "setupProjection" Evaluated [
        "F {scope.xy scope.xz scope.yx scope.yz scope.zx scope.zy world.xy world.xz world.yx world.yz world.zx world.zy} F~ F~ F?",
        "F {scope.xy scope.xz scope.yx scope.yz scope.zx scope.zy world.xy world.xz world.yx world.yz world.zx world.zy} F~ F~ F' F' F?"
    ]
    ShapeL "shapeL" Evaluated ["F F"]
    ShapeO "shapeO" Evaluated ["F F F F"]
    ShapeU "shapeU" Evaluated ["F F F"]
    SoftenNormals "softenNormals" Evaluated ["F"]
    Split "split" Evaluated ["{x y z} {adjust noAdjust}?", "{u v} {uvSpace unitSpace} F"]
    SplitAndSetbackPerimeter "splitAndSetbackPerimeter" Evaluated ["F'", "F' F B[]"]
    SplitArea "splitArea" Evaluated ["{x y z} {adjust noAdjust}?"]
    Subtract "subtract" Evaluated [""]
    T "t" Evaluated ["F' F' F'"]
    Tag "tag" Evaluated ["S {auto faces edges vertices}?"]
    Taper "taper" Evaluated ["F"]
    Texture "texture" Evaluated ["S"]
    TileUv "tileUV" Evaluated ["F F~ F~"]
    Translate "translate" Evaluated ["{abs rel} {scope pivot object world} F F F"]
    TranslateUv "translateUV" Evaluated ["F F F"]
    Trim "trim" Evaluated [""]
    Union "union" Evaluated [""]
}

impl Operation {
    /// Names of older versions that mean the same (reference 9).
    pub fn from_deprecated(name: &str) -> Option<Operation> {
        match name {
            "offsetUV" => Some(Operation::TranslateUv),
            "setupUV" => Some(Operation::SetupProjection),
            "bakeUV" => Some(Operation::ProjectUv),
            _ => None,
        }
    }

    /// Whether the result depends on tags.
    pub fn observes_tags(self) -> bool {
        self == Operation::CleanupGeometry
    }

    /// Whether a block `{ … }` follows the arguments.
    pub fn takes_block(self) -> bool {
        use Operation as O;
        self.makes_shapes() || matches!(self, O::Modify | O::Inline | O::Union | O::Subtract | O::Intersect)
    }

    /// Whether the operation puts geometry into the scope: `i` and the primitives. Trim planes cut it (reference 3.8).
    pub fn inserts(self) -> bool {
        use Operation as O;
        matches!(
            self,
            O::Insert
                | O::PrimitiveCone
                | O::PrimitiveCube
                | O::PrimitiveCylinder
                | O::PrimitiveDisk
                | O::PrimitiveQuad
                | O::PrimitiveSphere
        )
    }

    /// Whether the operation counts as creating or discarding shapes, so that no anonymous leaf follows
    /// (reference 2.1).
    pub fn makes_shapes(self) -> bool {
        use Operation as O;
        matches!(
            self,
            O::Split
                | O::SplitArea
                | O::SplitAndSetbackPerimeter
                | O::Comp
                | O::Setback
                | O::SetbackPerEdge
                | O::SetbackToArea
                | O::ShapeL
                | O::ShapeU
                | O::ShapeO
                | O::InnerRectangle
                | O::Scatter
        )
    }
}
