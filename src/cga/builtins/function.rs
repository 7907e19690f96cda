//! In: a name in an expression. Out: a [`Function`] with its overloads, result types and status.
//!
//! One row per function; every overload is "parameters -> result". To support a function in the interpreter, change
//! its row's `NotYet` to `Evaluated`.

use super::Status;
use super::Status::Evaluated;

macro_rules! functions {
    ($($variant:ident $name:literal $status:ident [$($signature:literal),*])*) => {
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

            pub fn status(self) -> Status {
                match self { $(Function::$variant => $status),* }
            }
        }
    };
}

functions! {
    Abs "abs" Evaluated ["F -> F", "F[] -> F[]"]
    Ceil "ceil" Evaluated ["F -> F", "F[] -> F[]"]
    Floor "floor" Evaluated ["F -> F", "F[] -> F[]"]
    Rint "rint" Evaluated ["F -> F", "F[] -> F[]"]
    Acos "acos" Evaluated ["F -> F"]
    Asin "asin" Evaluated ["F -> F"]
    Atan "atan" Evaluated ["F -> F"]
    Atan2 "atan2" Evaluated ["F F -> F"]
    Cos "cos" Evaluated ["F -> F"]
    Exp "exp" Evaluated ["F -> F"]
    Ln "ln" Evaluated ["F -> F"]
    Log10 "log10" Evaluated ["F -> F"]
    Pow "pow" Evaluated ["F F -> F"]
    Sin "sin" Evaluated ["F -> F"]
    Sqrt "sqrt" Evaluated ["F -> F"]
    Tan "tan" Evaluated ["F -> F"]
    IsInf "isinf" Evaluated ["F -> B", "F[] -> B[]"]
    IsNan "isnan" Evaluated ["F -> B", "F[] -> B[]"]
    IsNull "isNull" Evaluated ["F -> B", "S -> B", "F[] -> B[]", "S[] -> B[]"]
    Clamp "clamp" Evaluated ["F F F -> F", "S S S -> S", "F[] F[] F[] -> F[]", "S[] S[] S[] -> S[]"]
    Max "max" Evaluated ["F F -> F", "S S -> S", "F[] F[] -> F[]", "S[] S[] -> S[]"]
    Min "min" Evaluated ["F F -> F", "S S -> S", "F[] F[] -> F[]", "S[] S[] -> S[]"]
    Rand "rand" Evaluated ["F? F? -> F"]
    P "p" Evaluated ["F -> B"]
    Bool "bool" Evaluated ["F -> B", "B -> B", "S -> B"]
    Float "float" Evaluated ["F -> F", "B -> F", "S -> F"]
    Str "str" Evaluated ["X -> S"]
    BoolArray "boolArray" Evaluated ["A? -> B[]"]
    FloatArray "floatArray" Evaluated ["A? -> F[]"]
    StringArray "stringArray" Evaluated ["A? -> S[]"]
    Count "count" Evaluated ["S S -> F"]
    Find "find" Evaluated ["S S F -> F"]
    Len "len" Evaluated ["S -> F"]
    SplitString "splitString" Evaluated ["S S -> S[]"]
    Substring "substring" Evaluated ["S F F -> S"]
    Size "size" Evaluated ["A -> F"]
    NRows "nRows" Evaluated ["A -> F"]
    NColumns "nColumns" Evaluated ["A -> F"]
    FindFirst "findFirst" Evaluated ["S S -> F", "S[] S -> F", "B[] B -> F", "F[] F F? -> F"]
    SetElems "setElems" Evaluated [
        "F[] F F -> F[]", "F[] F[] F -> F[]", "F[] F[] F[] -> F[]", "F[] F F F -> F[]",
        "S[] F S -> S[]", "S[] F[] S -> S[]", "S[] F[] S[] -> S[]", "S[] F F S -> S[]",
        "B[] F B -> B[]", "B[] F[] B -> B[]", "B[] F[] B[] -> B[]", "B[] F F B -> B[]"
    ]
    SortIndices "sortIndices" Evaluated ["F[] -> F[]", "S[] -> F[]"]
    SortRowIndices "sortRowIndices" Evaluated ["F[] -> F[]", "S[] -> F[]"]
    Sum "sum" Evaluated ["F[] -> F", "B[] -> F", "S[] -> S"]
    Transpose "transpose" Evaluated ["F[] -> F[]", "B[] -> B[]", "S[] -> S[]"]
    GeometryArea "geometry.area" Evaluated ["-> F", "{@orientation surface} -> F"]
    GeometryAngle "geometry.angle" Evaluated ["{maxSlope azimuth zenith} -> F"]
    GeometryBoundaryLength "geometry.boundaryLength" Evaluated ["-> F"]
    GeometryDu "geometry.du" Evaluated ["F {uvSpace unitSpace} -> F"]
    GeometryDv "geometry.dv" Evaluated ["F {uvSpace unitSpace} -> F"]
    GeometryGroups "geometry.groups" Evaluated ["-> S[]"]
    GeometryMaterials "geometry.materials" Evaluated ["-> S[]"]
    GeometryHasTags "geometry.hasTags" Evaluated ["S? {all faces edges vertices}? -> B"]
    GeometryTags "geometry.tags" Evaluated ["S? {all faces edges vertices}? -> S[]"]
    GeometryHasUvs "geometry.hasUVs" Evaluated ["F? -> B"]
    GeometryHeight "geometry.height" Evaluated ["-> F"]
    GeometryIsClosedSurface "geometry.isClosedSurface" Evaluated ["-> B"]
    GeometryIsConcave "geometry.isConcave" Evaluated ["-> B"]
    GeometryIsInstanced "geometry.isInstanced" Evaluated ["-> B"]
    GeometryIsOriented "geometry.isOriented" Evaluated ["{@orientation} -> B"]
    GeometryIsPlanar "geometry.isPlanar" Evaluated ["F -> B"]
    GeometryIsRectangular "geometry.isRectangular" Evaluated ["F -> B"]
    GeometryNEdges "geometry.nEdges" Evaluated ["-> F"]
    GeometryNFaces "geometry.nFaces" Evaluated ["-> F"]
    GeometryNHoles "geometry.nHoles" Evaluated ["-> F"]
    GeometryNVertices "geometry.nVertices" Evaluated ["-> F"]
    GeometryVolume "geometry.volume" Evaluated ["-> F"]
    GeometryUMin "geometry.uMin" Evaluated ["F? -> F"]
    GeometryUMax "geometry.uMax" Evaluated ["F? -> F"]
    GeometryVMin "geometry.vMin" Evaluated ["F? -> F"]
    GeometryVMax "geometry.vMax" Evaluated ["F? -> F"]
    IsTagged "isTagged" Evaluated ["S {e v}? -> B"]
    GetMaterial "getMaterial" Evaluated ["{used shape geometry} {changed all} -> S[]"]
    ReadMaterial "readMaterial" Evaluated ["S -> S[]"]
    FileExists "fileExists" Evaluated ["S -> B"]
    FileSearch "fileSearch" Evaluated ["S -> S"]
    FilesSearch "filesSearch" Evaluated ["S -> S[]"]
    ReadTextFile "readTextFile" Evaluated ["S -> S"]
    ReadStringTable "readStringTable" Evaluated ["S -> S[]"]
    ReadFloatTable "readFloatTable" Evaluated ["S -> F[]"]
    AssetInfo "assetInfo" Evaluated ["S {sx sy sz tx ty tz} -> F"]
    AssetMetadata "assetMetadata" Evaluated ["S S F -> F", "S S B -> B", "S S S -> S"]
    AssetNamingInfo "assetNamingInfo" Evaluated ["S {g m} -> S"]
    AssetNamingInfos "assetNamingInfos" Evaluated ["S {g m} -> S[]"]
    AssetsSortRatio "assetsSortRatio" Evaluated ["S {xy xz yz xyz} -> S", "S[] {xy xz yz xyz} -> S[]"]
    AssetsSortSize "assetsSortSize" Evaluated ["S {x y z xy xz yz xyz} F -> S", "S[] {x y z xy xz yz xyz} F -> S[]"]
    ImageInfo "imageInfo" Evaluated ["S {sx sy} -> F"]
    ImagesSortRatio "imagesSortRatio" Evaluated ["S {xy xz yx yz zx zy} -> S", "S[] {xy xz yx yz zx zy} -> S[]"]
    Inside "inside" Evaluated ["{intra inter all}? S? -> B"]
    Overlaps "overlaps" Evaluated ["{intra inter all}? S? -> B"]
    Touches "touches" Evaluated ["{intra inter all}? S? -> B"]
    MinimumDistance "minimumDistance" Evaluated ["{intra inter all} S -> F"]
    ContextCount "contextCount" Evaluated ["{intra inter all} S -> F"]
    ContextCompare "contextCompare" Evaluated [
        "{intra inter all} S {world.northernmost world.southernmost world.easternmost world.westernmost world.highest world.lowest area.largest area.smallest} -> F"
    ]
    EdgeAttrGetFloat "edgeAttr.getFloat" Evaluated ["S -> F"]
    EdgeAttrGetString "edgeAttr.getString" Evaluated ["S -> S"]
    EdgeAttrGetBool "edgeAttr.getBool" Evaluated ["S -> B"]
    Convert "convert" Evaluated [
        "{x y z} {scope pivot object world} {scope pivot object world} {pos orient} F F F -> F",
        "{scope pivot object world} {scope pivot object world} {pos orient} F[] -> F[]"
    ]
    GetGeoCoord "getGeoCoord" Evaluated ["{X Y lon lat} -> F"]
    GetTreeKey "getTreeKey" Evaluated ["-> S"]
    Print "print" Evaluated ["F -> F", "B -> B", "S -> S", "F[] -> F[]", "B[] -> B[]", "S[] -> S[]"]
    FindLast "findLast" Evaluated ["S S -> F"]
    GetPrefix "getPrefix" Evaluated ["S S -> S"]
    GetSuffix "getSuffix" Evaluated ["S S -> S"]
    GetRange "getRange" Evaluated ["S S S -> S"]
    Replace "replace" Evaluated ["S S F -> S", "S S B -> S", "S S S -> S"]
    ListAdd "listAdd" Evaluated ["S S -> S"]
    ListClean "listClean" Evaluated ["S -> S"]
    ListFirst "listFirst" Evaluated ["S -> S"]
    ListItem "listItem" Evaluated ["S F -> S"]
    ListLast "listLast" Evaluated ["S -> S"]
    ListRandom "listRandom" Evaluated ["S -> S"]
    ListRange "listRange" Evaluated ["S F F -> S"]
    ListRemove "listRemove" Evaluated ["S S -> S"]
    ListRemoveAll "listRemoveAll" Evaluated ["S S -> S"]
    ListRetainAll "listRetainAll" Evaluated ["S S -> S"]
    ListTerminate "listTerminate" Evaluated ["S -> S"]
    ListFromArray "listFromArray" Evaluated ["A -> S"]
    ListToArray "listToArray" Evaluated ["S -> S[]"]
    ListCount "listCount" Evaluated ["S S -> F"]
    ListIndex "listIndex" Evaluated ["S S -> F"]
    ListSize "listSize" Evaluated ["S -> F"]
    FileBasename "fileBasename" Evaluated ["S -> S"]
    FileDirectory "fileDirectory" Evaluated ["S -> S"]
    FileExtension "fileExtension" Evaluated ["S -> S"]
    FileName "fileName" Evaluated ["S -> S"]
    FileRandom "fileRandom" Evaluated ["S -> S"]
    AssetBestRatio "assetBestRatio" Evaluated ["S S -> S"]
    AssetBestSize "assetBestSize" Evaluated ["S S -> S"]
    ImageBestRatio "imageBestRatio" Evaluated ["S S -> S"]
    AssetApproxRatio "assetApproxRatio" Evaluated ["S S F -> S"]
    AssetApproxSize "assetApproxSize" Evaluated ["S S F -> S"]
    ImageApproxRatio "imageApproxRatio" Evaluated ["S S F -> S"]
    AssetFitSize "assetFitSize" Evaluated ["S S F -> S"]
    ColorHexToR "colorHexToR" Evaluated ["S -> F"]
    ColorHexToG "colorHexToG" Evaluated ["S -> F"]
    ColorHexToB "colorHexToB" Evaluated ["S -> F"]
    ColorHexToO "colorHexToO" Evaluated ["S -> F"]
    ColorHexToH "colorHexToH" Evaluated ["S -> F"]
    ColorHexToS "colorHexToS" Evaluated ["S -> F"]
    ColorHexToV "colorHexToV" Evaluated ["S -> F"]
    ColorRgbToHex "colorRGBToHex" Evaluated ["F F F -> S"]
    ColorRgboToHex "colorRGBOToHex" Evaluated ["F F F F -> S"]
    ColorHsvToHex "colorHSVToHex" Evaluated ["F F F -> S"]
    ColorHsvoToHex "colorHSVOToHex" Evaluated ["F F F F -> S"]
    ColorRamp "colorRamp" Evaluated ["S F -> S"]
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
