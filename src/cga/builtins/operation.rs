//! In: a name in operation position. Out: an [`Operation`] with its overloads.
//!
//! Operations that take a block (`split`, `comp`, `setback`, ...) are here with the arguments before the block.

macro_rules! operations {
    ($($variant:ident $name:literal [$($signature:literal),*])*) => {
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
        }
    };
}

operations! {
    AlignScopeToAxes "alignScopeToAxes" ["{x y z world.x world.y world.z world.xyz object.x object.y object.z object.xyz}?"]
    AlignScopeToGeometry "alignScopeToGeometry" [
        "{yUp zUp} F{world.lowest largest any} F{world.lowest longest}", "{yUp zUp} F{auto}"
    ]
    AlignScopeToGeometryBBox "alignScopeToGeometryBBox" ["{xy yx xz zx yz zy}"]
    Center "center" ["{x y z xy xz yz xyz}"]
    CleanupGeometry "cleanupGeometry" ["{vertices edges faces all} F"]
    Color "color" ["S", "F F F F?"]
    Comp "comp" ["{f e fe v fv g m h} {zUp noAlign}?"]
    Convexify "convexify" ["F?"]
    CopyUv "copyUV" ["F F"]
    DeleteHoles "deleteHoles" [""]
    DeleteTags "deleteTags" ["S? {all faces edges vertices}?"]
    DeleteUv "deleteUV" ["F"]
    Envelope "envelope" [
        "{normal world.up} F F F", "{normal world.up} F F F F F", "{normal world.up} F F F F F F F",
        "{normal world.up} F F F F F F F F F", "{normal world.up} F F[] F[]",
        "F F F", "F F F F F", "F F F F F F F", "F F F F F F F F F"
    ]
    Extrude "extrude" [
        "F", "{face.normal vertex.normal world.up world.up.flatTop x y z world.x world.y world.z} F"
    ]
    Footprint "footprint" [""]
    Insert "i" [
        "S {yUp zUp}? {alignSizeAndPosition keepSizeAndPosition keepSizeAlignPosition}? {numericalCleanup noCleanup}?"
    ]
    Inline "inline" ["{append unify recompose}?"]
    InnerRect "innerRect" [""]
    InnerRectangle "innerRectangle" ["{scope edge}"]
    InsertAlongUv "insertAlongUV" ["F S F {scope.y vertex.normal}? {alignPosition keepPosition}?"]
    Intersect "intersect" [""]
    Label "label" ["S"]
    Mirror "mirror" ["B B B"]
    MirrorScope "mirrorScope" ["B B B"]
    Modify "modify" ["{f e fe v fv g m h} {zUp noAlign}?"]
    NormalizeUv "normalizeUV" ["F {uv uvUniform u v} {separatePerFace collectiveAllFaces}"]
    Offset "offset" ["F {all inside border}?"]
    PrimitiveCone "primitiveCone" ["F?", "F F F"]
    PrimitiveCube "primitiveCube" ["", "F F F"]
    PrimitiveCylinder "primitiveCylinder" ["F?", "F F F"]
    PrimitiveDisk "primitiveDisk" ["F? F?"]
    PrimitiveQuad "primitiveQuad" ["", "F F"]
    PrimitiveSphere "primitiveSphere" ["", "F F F?"]
    Print "print" ["X"]
    ProjectUv "projectUV" ["F"]
    R "r" ["{scopeOrigin scopeCenter} F F F", "F F F"]
    Rectify "rectify" ["F"]
    ReduceGeometry "reduceGeometry" ["F"]
    Report "report" ["S X"]
    ResetGeometry "resetGeometry" [""]
    ResetMaterial "resetMaterial" ["{shape geometry all}?"]
    ReverseNormals "reverseNormals" [""]
    RoofGable "roofGable" ["F F? F? B? F?", "{byAngle byHeight} F F? F? B? F?"]
    RoofHip "roofHip" ["F F? B?", "{byAngle byHeight} F F? B?"]
    RoofPyramid "roofPyramid" ["F", "{byAngle byHeight} F"]
    RoofRidge "roofRidge" ["{byAngle byHeight} F"]
    // An extension of Mansard: the map's roof:shape, roof:height or roof:angle, roof:direction or roof:orientation.
    RoofShape "roofShape" ["S {byAngle byHeight} F F{along across}?"]
    RoofShed "roofShed" ["F F?", "{byAngle byHeight} F F?"]
    Rotate "rotate" ["{abs rel} {scope pivot object world} F F F"]
    RotateScope "rotateScope" ["F F F"]
    RotateUv "rotateUV" ["F F"]
    S "s" ["F' F' F'"]
    ScaleUv "scaleUV" ["F F F"]
    Scatter "scatter" [
        "{surface volume scope} F {uniform gaussian}",
        "{surface volume scope} F {gaussian} {center front back left right top bottom} F'"
    ]
    Set "set" ["X X"]
    SetMaterial "setMaterial" ["S[]"]
    SetNormals "setNormals" ["{hard soft auto conform}"]
    SetPivot "setPivot" ["{xyz yzx zxy yUp zUp} F"]
    SetTagsFromEdgeAttrs "setTagsFromEdgeAttrs" [""]
    Setback "setback" ["F F?", "F[] F?"]
    SetbackPerEdge "setbackPerEdge" ["F F?"]
    SetbackToArea "setbackToArea" ["F F?", "F F[] F?", "F F[] F[] F?"]
    // With five arguments the last one is the uw factor (an old overload).
    SetupProjection "setupProjection" [
        "F {scope.xy scope.xz scope.yx scope.yz scope.zx scope.zy world.xy world.xz world.yx world.yz world.zx world.zy} F~ F~ F?",
        "F {scope.xy scope.xz scope.yx scope.yz scope.zx scope.zy world.xy world.xz world.yx world.yz world.zx world.zy} F~ F~ F' F' F?"
    ]
    ShapeL "shapeL" ["F F"]
    ShapeO "shapeO" ["F F F F"]
    ShapeU "shapeU" ["F F F"]
    SoftenNormals "softenNormals" ["F"]
    Split "split" ["{x y z} {adjust noAdjust}?", "{u v} {uvSpace unitSpace} F"]
    SplitAndSetbackPerimeter "splitAndSetbackPerimeter" ["F'", "F' F B[]"]
    SplitArea "splitArea" ["{x y z} {adjust noAdjust}?"]
    Subtract "subtract" [""]
    T "t" ["F' F' F'"]
    Tag "tag" ["S {auto faces edges vertices}?"]
    Taper "taper" ["F"]
    Texture "texture" ["S"]
    TileUv "tileUV" ["F F~ F~"]
    Translate "translate" ["{abs rel} {scope pivot object world} F F F"]
    TranslateUv "translateUV" ["F F F"]
    Trim "trim" [""]
    Union "union" [""]
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
