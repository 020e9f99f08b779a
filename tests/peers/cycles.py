"""Renders by Blender's Cycles what we render, for ray-tracing-bench --import.

    blender --background --python tests/peers/cycles.py -- SCENE.json FOLDER WIDTH HEIGHT SPP...

SCENE.json is what --export-scene wrote: spheres and quads, of lambertian, smooth metal, dielectric and emitter, before
a constant sky or a gradient. "monkey" in its place is a scene of Blender's own, which FOLDER/monkey.gltf then holds
for us.
Each SPP gives FOLDER/SPP.exr and a line "import: FOLDER/SPP.exr SECONDS": processor seconds of sampling alone over the
number of threads, which is wall time where nothing else runs.
"""
import json
import math
import os
import sys
from pathlib import Path

import bmesh
import bpy
from mathutils import Matrix, Vector

MAX_DEPTH = 50  # path vertices after the camera, as ours
SUBDIVISIONS = 6  # of an icosahedron for a sphere, shared by all of them: facets of a degree
HUGE = 100  # radius from which facets of a degree are too coarse beside small spheres


# ---- materials -------------------------------------------------------------------------------------------------------
def new_material(name, shader, **inputs):
    """A material of one shader; an input that is None has the object's colour."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    node = nodes.new(shader)
    for key, value in inputs.items():
        if value is None:
            links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], node.inputs[key])
        else:
            node.inputs[key].default_value = value
    links.new(node.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def of_object(material):
    """The shader, which is of a mesh that objects share, and the colour, which is each object's own."""
    kind = material["type"]
    if kind == "lambertian":
        return shared("lambertian", "ShaderNodeBsdfDiffuse", Color=None), material["albedo"]
    if kind == "metal" and material.get("fuzz", 0) == 0:
        return shared("metal", "ShaderNodeBsdfGlossy", Color=None, Roughness=0.0), material["albedo"]
    if kind == "dielectric":
        ior = material["ior"]
        return shared(f"glass {ior}", "ShaderNodeBsdfGlass", IOR=ior, Roughness=0.0), [1, 1, 1]
    if kind == "emitter":
        return shared("emitter", "ShaderNodeEmission", Color=None, Strength=1.0), material["emission"]
    raise SystemExit(f"cycles.py: material {material} has no counterpart")


def shared(name, shader, **inputs):
    return bpy.data.materials.get(name) or new_material(name, shader, **inputs)


# ---- objects ---------------------------------------------------------------------------------------------------------
def add_object(mesh, matrix, material, color):
    if not mesh.materials:
        mesh.materials.append(material)
    thing = bpy.data.objects.new("object", mesh)
    bpy.context.collection.objects.link(thing)
    thing.color = (*color, 1)
    thing.matrix_world = matrix
    # These move the ends of shadows on smooth meshes, which facets as small as ours do not need.
    thing.cycles.shadow_terminator_offset = 0
    thing.cycles.shadow_terminator_geometry_offset = 0
    return thing


def unit_sphere(material):
    """One mesh for all of a material."""
    name = "sphere of " + material.name
    mesh = bpy.data.meshes.get(name)
    if mesh is None:
        mesh = bpy.data.meshes.new(name)
        shape = bmesh.new()
        bmesh.ops.create_icosphere(shape, subdivisions=SUBDIVISIONS, radius=1)
        shape.to_mesh(mesh)
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return mesh


def huge_sphere(radius):
    """Around +y, rings whose distances grow from far below a small sphere's size."""
    angles = [0.0]
    while angles[-1] < math.pi:
        angles.append(angles[-1] + max(0.2 / radius, 0.01 * angles[-1]))
    angles[-1] = math.pi
    around = 256
    vertices, faces = [], []
    for angle in angles:
        for i in range(around):
            phi = 2 * math.pi * i / around
            vertices.append((math.sin(angle) * math.cos(phi), math.cos(angle), -math.sin(angle) * math.sin(phi)))
    for ring in range(len(angles) - 1):
        for i in range(around):
            a, b = ring * around + i, ring * around + (i + 1) % around
            faces.append((a, a + around, b + around, b))
    mesh = bpy.data.meshes.new("huge sphere")
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return mesh


def add_sphere(item, material):
    radius = item["radius"]
    shader, color = of_object(material)
    mesh = huge_sphere(radius) if radius > HUGE else unit_sphere(shader)
    add_object(mesh, Matrix.Translation(item["center"]) @ Matrix.Scale(radius, 4), shader, color)


def add_quad(item, material):
    corner, u, v = (Vector(item[key]) for key in ("corner", "edge_u", "edge_v"))
    if material["type"] == "emitter":
        add_area_light(corner, u, v, material["emission"])
        return
    mesh = bpy.data.meshes.new("quad")
    mesh.from_pydata([corner, corner + u, corner + u + v, corner + v], [], [(0, 1, 2, 3)])
    add_object(mesh, Matrix.Identity(4), *of_object(material))


def add_area_light(corner, u, v, radiance):
    """Cycles samples these by solid angle, and its meshes of light by area: the rectangle that suits it best."""
    light = bpy.data.lights.new("lamp", "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = u.length, v.length
    strongest = max(radiance)
    light.color = [value / strongest for value in radiance]
    light.energy = 4 * u.length * v.length * strongest
    light.cycles.max_bounces = 1024
    lamp = bpy.data.objects.new("lamp", light)
    x, z = u.normalized(), -u.cross(v).normalized()  # it shines along -z
    y = z.cross(x)
    lamp.matrix_world = Matrix.Translation(corner + u / 2 + v / 2) @ Matrix((x, y, z)).transposed().to_4x4()
    bpy.context.collection.objects.link(lamp)
    add_face(corner, u, v, radiance)


def add_face(corner, u, v, radiance):
    """What the camera sees of an area light, which Cycles shows in reflections alone."""
    material = new_material("face", "ShaderNodeEmission", Color=None, Strength=1.0)
    material.cycles.sample_as_light = False
    mesh = bpy.data.meshes.new("face")
    mesh.from_pydata([corner, corner + u, corner + u + v, corner + v], [], [(0, 1, 2, 3)])
    face = add_object(mesh, Matrix.Identity(4), material, radiance)
    face.visible_diffuse = face.visible_glossy = face.visible_transmission = face.visible_shadow = False
    face.visible_volume_scatter = False


def set_camera(description):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle_y = math.radians(description["vertical_fov"])
    camera.clip_start, camera.clip_end = 1e-3, 1e5
    look_from, look_at, up = (Vector(description[key]) for key in ("look_from", "look_at", "up"))
    z = (look_from - look_at).normalized()
    x = up.cross(z).normalized()
    angle = math.radians(description.get("defocus_angle", 0))
    if angle > 0:
        camera.dof.use_dof = True
        camera.dof.focus_distance = description["focus_distance"]
        radius = description["focus_distance"] * math.tan(angle / 2)
        camera.dof.aperture_fstop = 1e-3 * camera.lens / (2 * radius)
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = Matrix.Translation(look_from) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()
    bpy.context.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def set_sky(background):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    bpy.context.scene.world = world
    nodes, links = world.node_tree.nodes, world.node_tree.links
    color = nodes["Background"].inputs["Color"]
    if background["type"] == "constant":
        color.default_value = (*background["color"], 1)
        return
    if background["type"] != "gradient":
        raise SystemExit(f"cycles.py: background {background} has no counterpart")
    split, ramp, mix = (nodes.new("ShaderNode" + name) for name in ("SeparateXYZ", "MapRange", "MixRGB"))
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], split.inputs[0])
    ramp.inputs["From Min"].default_value = -1
    links.new(split.outputs["Y"], ramp.inputs["Value"])
    links.new(ramp.outputs[0], mix.inputs["Fac"])
    mix.inputs["Color1"].default_value = (*background["bottom"], 1)
    mix.inputs["Color2"].default_value = (*background["top"], 1)
    links.new(mix.outputs[0], color)


def read_scene(path):
    scene = json.loads(Path(path).read_text())
    for item in scene["objects"]:
        add = {"sphere": add_sphere, "quad": add_quad}.get(item["type"])
        if add is None:
            raise SystemExit(f"cycles.py: {item['type']} has no counterpart")
        add(item, scene["materials"][item["material"]])
    set_sky(scene["background"])
    set_camera(scene["camera"])


# ---- a scene that glTF holds -----------------------------------------------------------------------------------------
def plain(name, color):
    """What glTF calls diffuse alone: its exporter knows this shader."""
    material = new_material(name, "ShaderNodeBsdfPrincipled", Roughness=1.0, Specular=0.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    return material


def make_monkey(folder, width, height):
    """Blender's monkey on a floor below a lamp: written as glTF for us, then rendered with plain diffuse shaders."""
    bpy.ops.mesh.primitive_monkey_add(size=2, location=(0, 0, 1), rotation=(-0.6, 0, 0.5))
    monkey = bpy.context.object
    for kind, levels in (("SUBSURF", 3), ("TRIANGULATE", None)):  # flat: each renderer bends smooth normals its own way
        modifier = monkey.modifiers.new(kind, kind)
        if levels:
            modifier.levels = modifier.render_levels = levels
        bpy.ops.object.modifier_apply(modifier=modifier.name)
    bpy.ops.mesh.primitive_plane_add(size=20)
    floor = bpy.context.object
    bpy.ops.mesh.primitive_plane_add(size=2, location=(2, -2, 5), rotation=(math.pi - 0.5, 0.4, 0))
    lamp = bpy.context.object
    radiance = [12.0, 11.0, 9.0]
    colors = {monkey: (0.7, 0.35, 0.2), floor: (0.5, 0.5, 0.55)}
    for thing, color in colors.items():
        thing.data.materials.append(plain("plain", color))
    glow = new_material("lamp", "ShaderNodeEmission", Strength=max(radiance))
    glow.node_tree.nodes["Emission"].inputs["Color"].default_value = (*(r / max(radiance) for r in radiance), 1)
    glow.use_backface_culling = True
    lamp.data.materials.append(glow)
    set_camera({"look_from": (4, -7, 3.5), "look_at": (0, 0, 1), "up": (0, 0, 1), "vertical_fov": 35})
    set_sky({"type": "constant", "color": (0, 0, 0)})
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = width, height
    bpy.ops.export_scene.gltf(filepath=str(folder / "monkey.gltf"), export_format="GLTF_EMBEDDED", export_cameras=True,
                              export_apply=True)
    for thing, color in colors.items():
        thing.data.materials[0] = shared(f"diffuse {color}", "ShaderNodeBsdfDiffuse", Color=(*color, 1))
    corners = [lamp.matrix_world @ vertex.co for vertex in lamp.data.vertices]
    add_area_light(corners[0], corners[1] - corners[0], corners[2] - corners[0], radiance)
    bpy.data.objects.remove(lamp)


# ---- rendering -------------------------------------------------------------------------------------------------------
def set_up(width, height):
    """As we render: nothing clamped, filtered or ended early, no denoising."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, bounces, MAX_DEPTH)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1


def render(spp, path):
    """Seconds of all that Cycles does for it, and writes it."""
    bpy.context.scene.cycles.samples = spp
    begin = os.times()
    bpy.ops.render.render()
    end = os.times()
    seconds = (end.user + end.system - begin.user - begin.system) / len(os.sched_getaffinity(0))
    bpy.data.images["Render Result"].save_render(str(path))
    return seconds


def main(arguments):
    source, folder = arguments[0], Path(arguments[1])
    width, height, *steps = (int(text) for text in arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if source == "monkey":
        make_monkey(folder, width, height)
    else:
        read_scene(source)
    set_up(width, height)
    render(1, folder / "1.exr")  # what happens once
    one = min(render(1, folder / "1.exr") for _ in range(3))  # preparation and a sample
    for spp in steps:
        path = folder / f"{spp}.exr"
        seconds = (render(spp, path) - one) * spp / (spp - 1)
        print(f"import: {path} {seconds:.4g}", flush=True)


main(sys.argv[sys.argv.index("--") + 1:])
