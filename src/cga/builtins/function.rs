//! In: a name in an expression. Out: a [`Function`] with its overloads, result types.
//!
//! One row per function; every overload is "parameters -> result".

macro_rules! functions {
    ($($variant:ident $name:literal [$($signature:literal),*])*) => {
        /// A built-in or utility-library function.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Function { $($variant),* }

        impl Function {
            pub const ALL: &'static [Function] = &[$(Function::$variant),*];

            pub fn name(self) -> &'static str {
                match self { $(Function::$variant => $name),* }
            }

            pub fn from_name(name: &str) -> Option<Function> {
                match name { $($name => Some(Function::$variant),)* _ => None }
            }

            /// The overloads, as [`super::Signature`] texts.
            pub fn signatures(self) -> &'static [&'static str] {
                match self { $(Function::$variant => &[$($signature),*]),* }
            }
        }
    };
}

functions! {
    Abs "abs" ["F -> F", "F[] -> F[]"]
    Ceil "ceil" ["F -> F", "F[] -> F[]"]
    Floor "floor" ["F -> F", "F[] -> F[]"]
    Rint "rint" ["F -> F", "F[] -> F[]"]
    Acos "acos" ["F -> F"]
    Asin "asin" ["F -> F"]
    Atan "atan" ["F -> F"]
    Atan2 "atan2" ["F F -> F"]
    Cos "cos" ["F -> F"]
    Exp "exp" ["F -> F"]
    Ln "ln" ["F -> F"]
    Log10 "log10" ["F -> F"]
    Pow "pow" ["F F -> F"]
    Sin "sin" ["F -> F"]
    Sqrt "sqrt" ["F -> F"]
    Tan "tan" ["F -> F"]
    IsInf "isinf" ["F -> B", "F[] -> B[]"]
    IsNan "isnan" ["F -> B", "F[] -> B[]"]
    IsNull "isNull" ["F -> B", "S -> B", "F[] -> B[]", "S[] -> B[]"]
    Clamp "clamp" ["F F F -> F", "S S S -> S", "F[] F[] F[] -> F[]", "S[] S[] S[] -> S[]"]
    Max "max" ["F F -> F", "S S -> S", "F[] F[] -> F[]", "S[] S[] -> S[]"]
    Min "min" ["F F -> F", "S S -> S", "F[] F[] -> F[]", "S[] S[] -> S[]"]
    Rand "rand" ["F? F? -> F"]
    P "p" ["F -> B"]
    Bool "bool" ["F -> B", "B -> B", "S -> B"]
    Float "float" ["F -> F", "B -> F", "S -> F"]
    Str "str" ["X -> S"]
    BoolArray "boolArray" ["A? -> B[]"]
    FloatArray "floatArray" ["A? -> F[]"]
    StringArray "stringArray" ["A? -> S[]"]
    Count "count" ["S S -> F"]
    Find "find" ["S S F -> F"]
    Len "len" ["S -> F"]
    SplitString "splitString" ["S S -> S[]"]
    Substring "substring" ["S F F -> S"]
    Size "size" ["A -> F"]
    NRows "nRows" ["A -> F"]
    NColumns "nColumns" ["A -> F"]
    FindFirst "findFirst" ["S S -> F", "S[] S -> F", "B[] B -> F", "F[] F F? -> F"]
    SetElems "setElems" [
        "F[] F F -> F[]", "F[] F[] F -> F[]", "F[] F[] F[] -> F[]", "F[] F F F -> F[]",
        "S[] F S -> S[]", "S[] F[] S -> S[]", "S[] F[] S[] -> S[]", "S[] F F S -> S[]",
        "B[] F B -> B[]", "B[] F[] B -> B[]", "B[] F[] B[] -> B[]", "B[] F F B -> B[]"
    ]
    SortIndices "sortIndices" ["F[] -> F[]", "S[] -> F[]"]
    SortRowIndices "sortRowIndices" ["F[] -> F[]", "S[] -> F[]"]
    Sum "sum" ["F[] -> F", "B[] -> F", "S[] -> S"]
    Transpose "transpose" ["F[] -> F[]", "B[] -> B[]", "S[] -> S[]"]
    GeometryArea "geometry.area" ["-> F", "{@orientation surface} -> F"]
    GeometryAngle "geometry.angle" ["{maxSlope azimuth zenith} -> F"]
    GeometryBoundaryLength "geometry.boundaryLength" ["-> F"]
    GeometryDu "geometry.du" ["F {uvSpace unitSpace} -> F"]
    GeometryDv "geometry.dv" ["F {uvSpace unitSpace} -> F"]
    GeometryGroups "geometry.groups" ["-> S[]"]
    GeometryMaterials "geometry.materials" ["-> S[]"]
    GeometryHasTags "geometry.hasTags" ["S? {all faces edges vertices}? -> B"]
    GeometryTags "geometry.tags" ["S? {all faces edges vertices}? -> S[]"]
    GeometryHasUvs "geometry.hasUVs" ["F? -> B"]
    GeometryHeight "geometry.height" ["-> F"]
    GeometryIsClosedSurface "geometry.isClosedSurface" ["-> B"]
    GeometryIsConcave "geometry.isConcave" ["-> B"]
    GeometryIsInstanced "geometry.isInstanced" ["-> B"]
    GeometryIsOriented "geometry.isOriented" ["{@orientation} -> B"]
    GeometryIsPlanar "geometry.isPlanar" ["F -> B"]
    GeometryIsRectangular "geometry.isRectangular" ["F -> B"]
    GeometryNEdges "geometry.nEdges" ["-> F"]
    GeometryNFaces "geometry.nFaces" ["-> F"]
    GeometryNHoles "geometry.nHoles" ["-> F"]
    GeometryNVertices "geometry.nVertices" ["-> F"]
    GeometryVolume "geometry.volume" ["-> F"]
    GeometryUMin "geometry.uMin" ["F? -> F"]
    GeometryUMax "geometry.uMax" ["F? -> F"]
    GeometryVMin "geometry.vMin" ["F? -> F"]
    GeometryVMax "geometry.vMax" ["F? -> F"]
    IsTagged "isTagged" ["S {e v}? -> B"]
    GetMaterial "getMaterial" ["{used shape geometry} {changed all} -> S[]"]
    ReadMaterial "readMaterial" ["S -> S[]"]
    FileExists "fileExists" ["S -> B"]
    FileSearch "fileSearch" ["S -> S"]
    FilesSearch "filesSearch" ["S -> S[]"]
    ReadTextFile "readTextFile" ["S -> S"]
    ReadStringTable "readStringTable" ["S -> S[]"]
    ReadFloatTable "readFloatTable" ["S -> F[]"]
    AssetInfo "assetInfo" ["S {sx sy sz tx ty tz} -> F"]
    AssetMetadata "assetMetadata" ["S S F -> F", "S S B -> B", "S S S -> S"]
    AssetNamingInfo "assetNamingInfo" ["S {g m} -> S"]
    AssetNamingInfos "assetNamingInfos" ["S {g m} -> S[]"]
    AssetsSortRatio "assetsSortRatio" ["S {xy xz yz xyz} -> S", "S[] {xy xz yz xyz} -> S[]"]
    AssetsSortSize "assetsSortSize" ["S {x y z xy xz yz xyz} F -> S", "S[] {x y z xy xz yz xyz} F -> S[]"]
    ImageInfo "imageInfo" ["S {sx sy} -> F"]
    ImagesSortRatio "imagesSortRatio" ["S {xy xz yx yz zx zy} -> S", "S[] {xy xz yx yz zx zy} -> S[]"]
    Inside "inside" ["{intra inter all}? S? -> B"]
    Overlaps "overlaps" ["{intra inter all}? S? -> B"]
    Touches "touches" ["{intra inter all}? S? -> B"]
    MinimumDistance "minimumDistance" ["{intra inter all} S -> F"]
    ContextCount "contextCount" ["{intra inter all} S -> F"]
    ContextCompare "contextCompare" [
        "{intra inter all} S {world.northernmost world.southernmost world.easternmost world.westernmost world.highest world.lowest area.largest area.smallest} -> F"
    ]
    EdgeAttrGetFloat "edgeAttr.getFloat" ["S -> F"]
    EdgeAttrGetString "edgeAttr.getString" ["S -> S"]
    EdgeAttrGetBool "edgeAttr.getBool" ["S -> B"]
    Convert "convert" [
        "{x y z} {scope pivot object world} {scope pivot object world} {pos orient} F F F -> F",
        "{scope pivot object world} {scope pivot object world} {pos orient} F[] -> F[]"
    ]
    GetGeoCoord "getGeoCoord" ["{X Y lon lat} -> F"]
    GetTreeKey "getTreeKey" ["-> S"]
    Print "print" ["F -> F", "B -> B", "S -> S", "F[] -> F[]", "B[] -> B[]", "S[] -> S[]"]
    FindLast "findLast" ["S S -> F"]
    GetPrefix "getPrefix" ["S S -> S"]
    GetSuffix "getSuffix" ["S S -> S"]
    GetRange "getRange" ["S S S -> S"]
    Replace "replace" ["S S F -> S", "S S B -> S", "S S S -> S"]
    ListAdd "listAdd" ["S S -> S"]
    ListClean "listClean" ["S -> S"]
    ListFirst "listFirst" ["S -> S"]
    ListItem "listItem" ["S F -> S"]
    ListLast "listLast" ["S -> S"]
    ListRandom "listRandom" ["S -> S"]
    ListRange "listRange" ["S F F -> S"]
    ListRemove "listRemove" ["S S -> S"]
    ListRemoveAll "listRemoveAll" ["S S -> S"]
    ListRetainAll "listRetainAll" ["S S -> S"]
    ListTerminate "listTerminate" ["S -> S"]
    ListFromArray "listFromArray" ["A -> S"]
    ListToArray "listToArray" ["S -> S[]"]
    ListCount "listCount" ["S S -> F"]
    ListIndex "listIndex" ["S S -> F"]
    ListSize "listSize" ["S -> F"]
    FileBasename "fileBasename" ["S -> S"]
    FileDirectory "fileDirectory" ["S -> S"]
    FileExtension "fileExtension" ["S -> S"]
    FileName "fileName" ["S -> S"]
    FileRandom "fileRandom" ["S -> S"]
    AssetBestRatio "assetBestRatio" ["S S -> S"]
    AssetBestSize "assetBestSize" ["S S -> S"]
    ImageBestRatio "imageBestRatio" ["S S -> S"]
    AssetApproxRatio "assetApproxRatio" ["S S F -> S"]
    AssetApproxSize "assetApproxSize" ["S S F -> S"]
    ImageApproxRatio "imageApproxRatio" ["S S F -> S"]
    AssetFitSize "assetFitSize" ["S S F -> S"]
    ColorHexToR "colorHexToR" ["S -> F"]
    ColorHexToG "colorHexToG" ["S -> F"]
    ColorHexToB "colorHexToB" ["S -> F"]
    ColorHexToO "colorHexToO" ["S -> F"]
    ColorHexToH "colorHexToH" ["S -> F"]
    ColorHexToS "colorHexToS" ["S -> F"]
    ColorHexToV "colorHexToV" ["S -> F"]
    ColorRgbToHex "colorRGBToHex" ["F F F -> S"]
    ColorRgboToHex "colorRGBOToHex" ["F F F F -> S"]
    ColorHsvToHex "colorHSVToHex" ["F F F -> S"]
    ColorHsvoToHex "colorHSVOToHex" ["F F F F -> S"]
    ColorRamp "colorRamp" ["S F -> S"]
}

impl Function {
    /// Names of older versions that mean the same (reference 9).
    pub fn from_deprecated(name: &str) -> Option<Function> {
        match name {
            "index" => Some(Function::FindFirst),
            "uid" => Some(Function::GetTreeKey),
            _ => None,
        }
    }

    /// Whether the result depends on tags.
    pub fn observes_tags(self) -> bool {
        matches!(self, Function::IsTagged | Function::GeometryTags | Function::GeometryHasTags)
    }

    /// Whether a call draws random numbers.
    pub fn draws(self) -> bool {
        use Function as F;
        matches!(
            self,
            F::Rand
                | F::P
                | F::ListRandom
                | F::FileRandom
                | F::AssetApproxRatio
                | F::AssetApproxSize
                | F::ImageApproxRatio
                | F::ImageBestRatio
                | F::AssetFitSize
        )
    }
}
