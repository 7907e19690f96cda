//! In: a dotted name such as `scope.sx`. Out: the built-in attribute, its type, and whether `set` may write it
//! (reference 5).

use crate::cga::program::{Axis, Type};

/// A built-in attribute of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attr {
    ScopeTranslation(Axis),
    /// Degrees.
    ScopeRotation(Axis),
    ScopeSize(Axis),
    ScopeElevation,
    PivotPosition(Axis),
    PivotOrientation(Axis),
    InitialShapeName,
    InitialShapeStartRule,
    InitialShapeOrigin(Axis),
    InitialShapeOrientation(Axis),
    Seedian,
    SplitIndex,
    SplitTotal,
    CompSel,
    CompIndex,
    CompTotal,
    TrimHorizontal,
    TrimVertical,
    Material(MaterialAttr),
}

/// An attribute below `material.`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialAttr {
    Name,
    Shader,
    /// Channel 0 red, 1 green, 2 blue.
    Color(u8),
    ColorRgb,
    Ambient(u8),
    Specular(u8),
    Emissive(u8),
    Opacity,
    Reflectivity,
    Shininess,
    BumpValue,
    Metallic,
    Roughness,
    DoubleSided,
    Map(MapLayer, MapPart),
    OpacityMode,
    OpacityCutoff,
}

/// A texture layer; its uv set is its position here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapLayer {
    Color,
    Bump,
    Dirt,
    Specular,
    Opacity,
    Normal,
    Emissive,
    Occlusion,
    Roughness,
    Metallic,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapPart {
    Path,
    ScaleU,
    ScaleV,
    OffsetU,
    OffsetV,
    Rotation,
}

/// A row of the attribute table.
#[derive(Clone, Copy, Debug)]
pub struct AttrInfo {
    pub name: &'static str,
    pub attr: Attr,
    pub kind: Type,
    pub writable: bool,
    /// The row is an old spelling of another row.
    pub deprecated: bool,
}

const fn row(name: &'static str, attr: Attr, kind: Type, writable: bool) -> AttrInfo {
    AttrInfo { name, attr, kind, writable, deprecated: false }
}

const fn old(name: &'static str, attr: Attr, kind: Type, writable: bool) -> AttrInfo {
    AttrInfo { name, attr, kind, writable, deprecated: true }
}

const fn material(name: &'static str, attr: MaterialAttr, kind: Type) -> AttrInfo {
    row(name, Attr::Material(attr), kind, true)
}

macro_rules! maps {
    ($($name:literal $layer:ident)*) => {
        &[$(
            material(concat!("material.", $name), MaterialAttr::Map(MapLayer::$layer, MapPart::Path), Type::String),
            material(concat!("material.", $name, ".su"), MaterialAttr::Map(MapLayer::$layer, MapPart::ScaleU), Type::Float),
            material(concat!("material.", $name, ".sv"), MaterialAttr::Map(MapLayer::$layer, MapPart::ScaleV), Type::Float),
            material(concat!("material.", $name, ".tu"), MaterialAttr::Map(MapLayer::$layer, MapPart::OffsetU), Type::Float),
            material(concat!("material.", $name, ".tv"), MaterialAttr::Map(MapLayer::$layer, MapPart::OffsetV), Type::Float),
            material(concat!("material.", $name, ".rw"), MaterialAttr::Map(MapLayer::$layer, MapPart::Rotation), Type::Float),
        )*]
    };
}

static MAPS: &[AttrInfo] = maps! {
    "colormap" Color "bumpmap" Bump "dirtmap" Dirt "specularmap" Specular "opacitymap" Opacity "normalmap" Normal
    "emissivemap" Emissive "occlusionmap" Occlusion "roughnessmap" Roughness "metallicmap" Metallic
};

static ROWS: &[AttrInfo] = &[
    row("scope.tx", Attr::ScopeTranslation(Axis::X), Type::Float, true),
    row("scope.ty", Attr::ScopeTranslation(Axis::Y), Type::Float, true),
    row("scope.tz", Attr::ScopeTranslation(Axis::Z), Type::Float, true),
    row("scope.rx", Attr::ScopeRotation(Axis::X), Type::Float, true),
    row("scope.ry", Attr::ScopeRotation(Axis::Y), Type::Float, true),
    row("scope.rz", Attr::ScopeRotation(Axis::Z), Type::Float, true),
    row("scope.sx", Attr::ScopeSize(Axis::X), Type::Float, true),
    row("scope.sy", Attr::ScopeSize(Axis::Y), Type::Float, true),
    row("scope.sz", Attr::ScopeSize(Axis::Z), Type::Float, true),
    row("scope.elevation", Attr::ScopeElevation, Type::Float, false),
    row("pivot.px", Attr::PivotPosition(Axis::X), Type::Float, true),
    row("pivot.py", Attr::PivotPosition(Axis::Y), Type::Float, true),
    row("pivot.pz", Attr::PivotPosition(Axis::Z), Type::Float, true),
    row("pivot.ox", Attr::PivotOrientation(Axis::X), Type::Float, true),
    row("pivot.oy", Attr::PivotOrientation(Axis::Y), Type::Float, true),
    row("pivot.oz", Attr::PivotOrientation(Axis::Z), Type::Float, true),
    row("initialShape.name", Attr::InitialShapeName, Type::String, false),
    row("initialShape.startRule", Attr::InitialShapeStartRule, Type::String, false),
    old("initialShape.symbol", Attr::InitialShapeStartRule, Type::String, false),
    row("initialShape.origin.px", Attr::InitialShapeOrigin(Axis::X), Type::Float, false),
    row("initialShape.origin.py", Attr::InitialShapeOrigin(Axis::Y), Type::Float, false),
    row("initialShape.origin.pz", Attr::InitialShapeOrigin(Axis::Z), Type::Float, false),
    row("initialShape.origin.ox", Attr::InitialShapeOrientation(Axis::X), Type::Float, false),
    row("initialShape.origin.oy", Attr::InitialShapeOrientation(Axis::Y), Type::Float, false),
    row("initialShape.origin.oz", Attr::InitialShapeOrientation(Axis::Z), Type::Float, false),
    row("seedian", Attr::Seedian, Type::Float, true),
    row("split.index", Attr::SplitIndex, Type::Float, false),
    row("split.total", Attr::SplitTotal, Type::Float, false),
    row("comp.sel", Attr::CompSel, Type::String, false),
    row("comp.index", Attr::CompIndex, Type::Float, false),
    row("comp.total", Attr::CompTotal, Type::Float, false),
    row("trim.horizontal", Attr::TrimHorizontal, Type::Bool, true),
    row("trim.vertical", Attr::TrimVertical, Type::Bool, true),
    material("material.name", MaterialAttr::Name, Type::String),
    material("material.shader", MaterialAttr::Shader, Type::String),
    material("material.color.r", MaterialAttr::Color(0), Type::Float),
    material("material.color.g", MaterialAttr::Color(1), Type::Float),
    material("material.color.b", MaterialAttr::Color(2), Type::Float),
    material("material.color.rgb", MaterialAttr::ColorRgb, Type::String),
    material("material.ambient.r", MaterialAttr::Ambient(0), Type::Float),
    material("material.ambient.g", MaterialAttr::Ambient(1), Type::Float),
    material("material.ambient.b", MaterialAttr::Ambient(2), Type::Float),
    material("material.specular.r", MaterialAttr::Specular(0), Type::Float),
    material("material.specular.g", MaterialAttr::Specular(1), Type::Float),
    material("material.specular.b", MaterialAttr::Specular(2), Type::Float),
    material("material.emissive.r", MaterialAttr::Emissive(0), Type::Float),
    material("material.emissive.g", MaterialAttr::Emissive(1), Type::Float),
    material("material.emissive.b", MaterialAttr::Emissive(2), Type::Float),
    material("material.opacity", MaterialAttr::Opacity, Type::Float),
    old("material.map3", Attr::Material(MaterialAttr::Map(MapLayer::Specular, MapPart::Path)), Type::String, true),
    old("material.map4", Attr::Material(MaterialAttr::Map(MapLayer::Opacity, MapPart::Path)), Type::String, true),
    old("material.map5", Attr::Material(MaterialAttr::Map(MapLayer::Normal, MapPart::Path)), Type::String, true),
    old("material.color.a", Attr::Material(MaterialAttr::Opacity), Type::Float, true),
    material("material.reflectivity", MaterialAttr::Reflectivity, Type::Float),
    material("material.shininess", MaterialAttr::Shininess, Type::Float),
    material("material.bumpValue", MaterialAttr::BumpValue, Type::Float),
    old("material.bump", Attr::Material(MaterialAttr::BumpValue), Type::Float, true),
    material("material.metallic", MaterialAttr::Metallic, Type::Float),
    material("material.roughness", MaterialAttr::Roughness, Type::Float),
    material("material.doubleSided", MaterialAttr::DoubleSided, Type::Bool),
    material("material.opacitymap.mode", MaterialAttr::OpacityMode, Type::String),
    material("material.opacitymap.cutoff", MaterialAttr::OpacityCutoff, Type::Float),
];

impl Attr {
    /// Every row of the table.
    pub fn table() -> impl Iterator<Item = &'static AttrInfo> {
        ROWS.iter().chain(MAPS)
    }

    /// The row of a name as written.
    pub fn from_name(name: &str) -> Option<&'static AttrInfo> {
        // All but one name have a dot; most names that are looked up have none.
        let possible = name.contains('.') || name == "seedian";
        Self::table().filter(|_| possible).find(|row| row.name == name)
    }

    /// The row of this attribute under its present name.
    pub fn info(self) -> &'static AttrInfo {
        Self::table().find(|row| row.attr == self && !row.deprecated).expect("every attribute has a row")
    }
}
