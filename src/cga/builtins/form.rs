//! In: forms of a construct that the tables of names cannot tell apart. Out: their status.
//!
//! To support a form in the interpreter, change its row's `NotYet` to `Evaluated`.

use super::Status;
use super::Status::Evaluated;

macro_rules! forms {
    ($($variant:ident $text:literal $status:ident)*) => {
        /// A form of a construct with a status of its own.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Form { $($variant),* }

        impl Form {
            pub const ALL: &'static [Form] = &[$(Form::$variant),*];

            /// As messages name it.
            pub fn text(self) -> &'static str {
                match self { $(Form::$variant => $text),* }
            }

            pub fn status(self) -> Status {
                match self { $(Form::$variant => $status),* }
            }
        }
    };
}

forms! {
    CompFaces "comp(f)" Evaluated
    CompEdges "comp(e)" Evaluated
    CompFaceEdges "comp(fe)" Evaluated
    CompVertices "comp(v)" Evaluated
    CompFaceVertices "comp(fv)" Evaluated
    CompGroups "comp(g)" Evaluated
    CompMaterials "comp(m)" Evaluated
    CompHoles "comp(h)" Evaluated
    CompConnected "the selector operator `=:`" Evaluated
    CompKeepAxes "comp(..., noAlign)" Evaluated
    CompFunction "the comp function" Evaluated
    SplitUv "split(u | v, ...)" Evaluated
    StreetSelector "street selectors" Evaluated
    UvSelector "uv selectors" Evaluated
    RoofEdgeSelector "the selectors eave, hip, valley and ridge" Evaluated
    VertexNormalExtrusion "extrude(vertex.normal, ...)" Evaluated
    DynamicImport "a dynamic import call" Evaluated
    StreetWidth "the map attribute streetWidth" Evaluated
    ComputedSet "set(sel(...), ...)" Evaluated
}
