"""Mansard's frame beside Mitsuba 3 and Blender's Cycles: the same scene, camera and sun; time against error.

In: a folder that `mansard render tests/bench/renderers/window.render --set shadows=hard ...` wrote (scene.glb, manifest.json) and the
folder of the same frame that counts as the truth, such as one with `--set preset=high`. Out: a table on standard output, images beside them.

    python3 -m venv venv && venv/bin/pip install mitsuba==3.9.0 numpy pillow        # and bpy==5.0.1 for Cycles
    venv/bin/python tests/bench/renderers/compare.py --scene out/standard --truth out/truth --disc 0 \
        --mitsuba 1,4,16 --cycles 1,4

Errors are root mean squares of linear light, of images that were all rounded to 8-bit sRGB first. Times are those of the
renderer's own call, without loading the scene; the acceleration structure's time is told apart.
"""

import argparse, json, math, struct, sys, time
from pathlib import Path

import numpy as np


def load_glb(path):
    """One mesh per material of the glTF scene `before`: positions, normals, uvs, triangles; materials; images."""
    blob = Path(path).read_bytes()
    (length,) = struct.unpack_from("<I", blob, 12)
    root = json.loads(blob[20 : 20 + length])
    binary = blob[28 + length :]
    kinds = {5126: ("<f4", 4), 5125: ("<u4", 4), 5123: ("<u2", 2), 5121: ("u1", 1), 5120: ("i1", 1), 5122: ("<i2", 2)}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}

    def accessor(i):
        a = root["accessors"][i]
        view = root["bufferViews"][a["bufferView"]]
        kind, size = kinds[a["componentType"]]
        width = widths[a["type"]]
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        stride = view.get("byteStride", size * width)
        raw = np.ndarray((a["count"], width), kind, binary, start, (stride, size))
        if a.get("normalized"):
            return np.maximum(raw.astype(np.float64) / np.iinfo(raw.dtype).max, -1.0)
        return raw.astype(np.float64 if kind == "<f4" else np.int64)

    parts = {}
    before = next(s for s in root["scenes"] if s.get("name") == "before")
    stack = [(n, np.zeros(3)) for n in before["nodes"]]
    while stack:
        number, at = stack.pop()
        node = root["nodes"][number]
        at = at + np.array(node.get("translation", [0, 0, 0]))
        stack += [(c, at) for c in node.get("children", [])]
        for p in root["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            attributes = p["attributes"]
            positions = accessor(attributes["POSITION"]) + at
            uvs = accessor(attributes["TEXCOORD_0"]) if "TEXCOORD_0" in attributes else np.zeros((len(positions), 2))
            parts.setdefault(p["material"], []).append(
                (positions, accessor(attributes["NORMAL"]), uvs, accessor(p["indices"]).reshape(-1, 3))
            )
    meshes = {}
    for material, list_ in sorted(parts.items()):
        offsets = np.cumsum([0] + [len(p[0]) for p in list_])
        joined = [np.concatenate([p[k] for p in list_]) for k in range(3)]
        triangles = np.concatenate([p[3] + o for p, o in zip(list_, offsets)])
        meshes[material] = (*joined, triangles)
    images = []
    for image in root.get("images", []):
        view = root["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        images.append(binary[start : start + view["byteLength"]])
    return root, meshes, images


def write_ply(path, positions, normals, uvs, triangles):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(positions)
    header += "".join("property float %s\n" % n for n in ["x", "y", "z", "nx", "ny", "nz", "u", "v"])
    header += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(triangles)
    vertices = np.hstack([positions, normals, uvs]).astype("<f4")
    faces = np.zeros(len(triangles), dtype=[("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    Path(path).write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())


def srgb(linear):
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def linear(byte):
    x = byte.astype(np.float64) / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def load_image(path):
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = None
    return linear(np.asarray(Image.open(path).convert("RGB")))


def save(path, image):
    from PIL import Image

    Image.fromarray(np.rint(srgb(image) * 255).astype(np.uint8)).save(path)


def rounded(image):
    return linear(np.rint(srgb(image) * 255))


def sun_direction(record):
    elevation, azimuth = (math.radians(record[k]) for k in ["sun_elevation", "sun_azimuth"])
    return np.array(
        [math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth)]
    )


class Mitsuba:
    def __init__(self, scene, record, disc, folder):
        import mitsuba as mi

        mi.set_variant("scalar_rgb")
        self.mi = mi
        root, meshes, images = scene
        origin, forward = np.array(record["position"]), np.array(record["forward"])
        # One shared shift: f32 has little to give away at a camera's distance.
        shift = origin + forward * np.linalg.norm(origin)
        shift[1] = 0.0
        camera = mi.ScalarTransform4f().look_at(list(origin - shift), list(origin - shift + forward), record["up"])
        to_sun = sun_direction(record)
        described = {
            "type": "scene",
            "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0, "hide_emitters": True},
            "sensor": {
                "type": "perspective",
                "to_world": camera,
                "fov_axis": "x",
                "fov": 2 * math.degrees(math.atan(record["half_x"])),
                "near_clip": 1.0,
                "far_clip": 1e6,
                "film": {
                    "type": "hdrfilm",
                    "width": record["width"],
                    "height": record["height"],
                    "rfilter": {"type": "box"},
                    "component_format": "float32",
                },
                "sampler": {"type": "stratified", "sample_count": 4},
            },
        }
        if disc == 0:
            described["sun"] = {
                "type": "directional",
                "direction": list(-to_sun),
                "irradiance": {"type": "rgb", "value": [math.pi] * 3},
            }
        else:
            far = 5e4
            radius = far * math.tan(math.radians(disc / 2))
            described["sun"] = {
                "type": "disk",
                "to_world": mi.ScalarTransform4f().look_at(list(to_sun * far), [0, 0, 0], [0.3, 0.5, 0.7])
                @ mi.ScalarTransform4f().scale(radius),
                "emitter": {
                    "type": "area",
                    "radiance": {"type": "rgb", "value": [math.pi * far**2 / (math.pi * radius**2)] * 3},
                },
            }
        for material, (positions, normals, uvs, triangles) in meshes.items():
            about = root["materials"][material]
            pbr = about.get("pbrMetallicRoughness", {})
            factor = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
            reflectance = {"type": "rgb", "value": factor}
            if "baseColorTexture" in pbr:
                texture = root["textures"][pbr["baseColorTexture"]["index"]]
                at = folder / ("texture%d.png" % material)
                self.tinted(images[texture["source"]], factor, at)
                reflectance = {"type": "bitmap", "filename": str(at)}
                change = pbr["baseColorTexture"].get("extensions", {}).get("KHR_texture_transform")
                assert change is None, "texture transforms are not read here"
            ply = folder / ("part%d.ply" % material)
            write_ply(ply, positions - shift, normals, uvs, triangles)
            described["part%d" % material] = {
                "type": "ply",
                "filename": str(ply),
                "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": reflectance}},
            }
        start = time.perf_counter()
        self.scene = mi.load_dict(described)
        self.built = time.perf_counter() - start
        self.samples = {}

    @staticmethod
    def tinted(data, factor, at):
        import io

        from PIL import Image

        texels = linear(np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))) * np.array(factor)
        Image.fromarray(np.rint(srgb(texels) * 255).astype(np.uint8)).save(at)

    def render(self, samples):
        start = time.perf_counter()
        image = self.mi.render(self.scene, spp=samples)
        taken = time.perf_counter() - start
        return np.array(image, dtype=np.float64)[:, :, :3], taken


class Cycles:
    def __init__(self, scene, record, disc, folder):
        import bpy
        from mathutils import Matrix, Vector

        self.bpy, self.folder = bpy, folder
        root, meshes, images = scene
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = scene = bpy.context.scene
        start = time.perf_counter()
        origin, forward = np.array(record["position"]), np.array(record["forward"])
        shift = origin + forward * np.linalg.norm(origin)
        shift[1] = 0.0
        # glTF's y up becomes z up.
        turn = lambda v: Vector((v[0], -v[2], v[1]))
        for number, (positions, normals, uvs, triangles) in meshes.items():
            mesh = bpy.data.meshes.new("part%d" % number)
            mesh.vertices.add(len(positions))
            moved = positions - shift
            mesh.vertices.foreach_set("co", np.stack([moved[:, 0], -moved[:, 2], moved[:, 1]], 1).astype(np.float32).ravel())
            mesh.loops.add(triangles.size)
            mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
            mesh.polygons.add(len(triangles))
            mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
            mesh.uv_layers.new(name="uv")
            mesh.uv_layers[0].data.foreach_set("uv", np.stack([uvs[:, 0], 1 - uvs[:, 1]], 1)[triangles.ravel()].astype(np.float32).ravel())
            mesh.update(calc_edges=True)
            turned = np.stack([normals[:, 0], -normals[:, 2], normals[:, 1]], 1)
            mesh.normals_split_custom_set_from_vertices(turned.astype(np.float32))
            mesh.materials.append(self.material(root, images, number, folder))
            scene.collection.objects.link(bpy.data.objects.new("part%d" % number, mesh))
        camera = bpy.data.cameras.new("camera")
        camera.sensor_fit, camera.angle = "HORIZONTAL", 2 * math.atan(record["half_x"])
        camera.clip_start, camera.clip_end = 1.0, 1e6
        there = bpy.data.objects.new("camera", camera)
        right, up, back = turn(record["right"]), turn(record["up"]), -turn(record["forward"])
        matrix = Matrix((right, up, back)).transposed().to_4x4()
        matrix.translation = turn(origin - shift)
        there.matrix_world = matrix
        scene.collection.objects.link(there)
        scene.camera = there
        sun = bpy.data.lights.new("sun", "SUN")
        sun.energy, sun.angle = math.pi, math.radians(disc)
        lamp = bpy.data.objects.new("sun", sun)
        lamp.rotation_mode = "QUATERNION"
        lamp.rotation_quaternion = turn(sun_direction(record)).to_track_quat("Z", "Y")
        scene.collection.objects.link(lamp)
        scene.render.engine = "CYCLES"
        scene.cycles.device = "CPU"
        scene.cycles.max_bounces = 0
        scene.cycles.use_denoising = False
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.filter_width = 1.0
        scene.render.resolution_x, scene.render.resolution_y = record["width"], record["height"]
        scene.render.resolution_percentage = 100
        scene.render.use_persistent_data = True
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.view_settings.view_transform = "Raw"
        self.built = time.perf_counter() - start

    def material(self, root, images, number, folder):
        """Diffuse alone, as the others."""
        about = root["materials"][number].get("pbrMetallicRoughness", {})
        factor = about.get("baseColorFactor", [1, 1, 1, 1])[:3]
        material = self.bpy.data.materials.new("part%d" % number)
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        shader, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        links.new(shader.outputs[0], output.inputs["Surface"])
        shader.inputs["Color"].default_value = (*factor, 1)
        if "baseColorTexture" in about:
            texture = root["textures"][about["baseColorTexture"]["index"]]
            at = folder / ("texture%d.png" % number)
            Mitsuba.tinted(images[texture["source"]], factor, at)
            picture = nodes.new("ShaderNodeTexImage")
            picture.image = self.bpy.data.images.load(str(at.resolve()))
            links.new(picture.outputs["Color"], shader.inputs["Color"])
        return material

    def render(self, samples):
        self.scene.cycles.samples = samples
        path = self.folder / ("cycles%d.exr" % samples)
        self.scene.render.filepath = str(path.resolve())
        start = time.perf_counter()
        self.bpy.ops.render.render(write_still=True, scene=self.scene.name)
        taken = time.perf_counter() - start
        image = self.bpy.data.images.load(str(path))
        image.colorspace_settings.name = "Non-Color"
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(height, width, 4)[::-1, :, :3].astype(np.float64), taken


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", type=Path, required=True, help="a folder of `mansard render`")
    parser.add_argument("--truth", type=Path, required=True, help="the same view by the reference")
    parser.add_argument("--also", type=Path, nargs="*", default=[], help="more folders of `mansard render` to judge")
    parser.add_argument("--disc", type=float, default=0.0, help="diameter of the sun, degrees")
    parser.add_argument("--mitsuba", default="", help="samples per pixel, with commas")
    parser.add_argument("--cycles", default="", help="samples per pixel, with commas")
    options = parser.parse_args()
    manifest = json.loads((options.scene / "manifest.json").read_text())
    view = manifest["views"][0]
    record = next(a for a in view["acquisitions"] if "frame" in a["images"])
    file = view["images"]["frame"]["path"]
    truth = load_image(options.truth / file)
    # Where nothing is drawn every renderer has its own constant.
    ids = options.scene / view["images"]["ids"]["path"]
    seen = np.any(load_image_raw(ids) != 0, axis=-1)
    error = lambda image: math.sqrt(np.mean((rounded(image) - truth)[seen] ** 2))
    print("| renderer | samples per pixel | s | RMS error |\n| --- | --- | --- | --- |")
    for folder in [options.scene, *options.also]:
        print("| Mansard %s | | | %.5f |" % (folder.name, error(load_image(folder / file))), flush=True)
    work = options.scene / "compare"
    work.mkdir(exist_ok=True)
    rivals = []
    if options.mitsuba:
        rivals.append(("Mitsuba scalar_rgb", options.mitsuba, lambda: Mitsuba(load_glb(options.scene / "scene.glb"), record, options.disc, work)))
    if options.cycles:
        rivals.append(("Cycles", options.cycles, lambda: Cycles(load_glb(options.scene / "scene.glb"), record, options.disc, work)))
    for name, counts, make in rivals:
        rival = make()
        print("| %s, scene loaded | | %.1f | |" % (name, rival.built), flush=True)
        for samples in map(int, counts.split(",")):
            image, taken = rival.render(samples)
            save(work / ("%s-%d.png" % (name.split()[0].lower(), samples)), image)
            print("| %s | %d | %.1f | %.5f |" % (name, samples, taken, error(image)), flush=True)


def load_image_raw(path):
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = None
    image = np.asarray(Image.open(path))
    return image if image.ndim == 3 else image[:, :, None]


if __name__ == "__main__":
    sys.exit(main())
