"""Scenes: nested dicts with the names of scene files, and what they are compiled to."""

from __future__ import annotations

import collections.abc
import copy
import json
import math
import os
import warnings
from typing import Any, Iterator, NamedTuple, Union

import numpy as np

from . import _arguments, _core, _flags
from ._json import to_json

Source = Union[str, "os.PathLike[str]", dict, "Scene"]
_ORIGIN = np.zeros(3, np.float32)
_CENTRE = np.full(2, 0.5, np.float32)


class Notice(UserWarning):
    """What a scene has that its author may not expect, such as an asset that is missing and was generated."""


class Hits(NamedTuple):
    """What N rays hit. Where a ray hits nothing t is infinite, indices are -1 and vectors 0."""

    t: np.ndarray  #: (N,) distance along the ray, world units
    kind: np.ndarray  #: (N,) int32: 0 sphere, 1 quad, 2 triangle, 3 disk or cylinder
    primitive: np.ndarray  #: (N,) int32, among those of its kind
    instance: np.ndarray  #: (N,) int32; -1: of the world itself
    position: np.ndarray  #: (N, 3) world units
    normal: np.ndarray  #: (N, 3) geometric, unit, on the front side
    shading: np.ndarray  #: (N, 3) interpolated, unit
    uv: np.ndarray  #: (N, 2) texture coordinates
    material: np.ndarray  #: (N,) int32, into Compiled.materials
    light: np.ndarray  #: (N,) int32, into Compiled.lights; -1: none


class LightSamples(NamedTuple):
    """Directions to a light from N points. pdf 0: the light cannot contribute there, and all else is 0, the direction,
    too, in which no ray hits anything, no density and no value is above 0."""

    direction: np.ndarray  #: (N, 3) unit, from the point to the light
    distance: np.ndarray  #: (N,) world units; infinite: the sky, or a directional light
    pdf: np.ndarray  #: (N,) per steradian, given this light; of a light without extent 1, a probability
    radiance: np.ndarray  #: (N, 3) that arrives if nothing is in between; of a light without extent irradiance
    point: np.ndarray  #: (N, 3) on the light, world units
    normal: np.ndarray  #: (N, 3) unit, of the light there


class BsdfSamples(NamedTuple):
    """N scattered directions."""

    wi: np.ndarray  #: (N, 3) unit, away from the surface
    weight: np.ndarray  #: (N, 3) value * |cosine| / density; 0: absorbed
    pdf: np.ndarray  #: (N,) per steradian; 0 of a delta lobe
    delta: np.ndarray  #: (N,) bool: the only direction of its lobe
    transmitted: np.ndarray  #: (N,) bool: on the other side of the surface


class Compiled:
    """A scene as renderers see it: arrays of records in single precision. It does not change any more.

    Arrays are float32, C-contiguous and finite. One row, such as a single point of shape (3,), stands for as many as
    the other arguments have. Points are in world units; random numbers lie in [0, 1). Directions and normals have
    length 1, or 0 for none, as those of a light that cannot be sampled, of rays that hit nothing and of what was
    absorbed: a direction that is none hits nothing, and its densities and values are 0. Formulas are those of the
    renderers, Common/Shared, with their sources.
    """

    def __init__(self, core: _core.Compiled) -> None:
        self._core = core

    def __repr__(self) -> str:
        return f"<raytracing.Compiled {self._core.id!r}, {len(self.lights)} lights>"

    @property
    def id(self) -> str:
        return self._core.id

    @property
    def width(self) -> int:
        """Of the image, in pixels."""
        return self._core.width

    @property
    def height(self) -> int:
        return self._core.height

    @property
    def materials(self) -> list[str]:
        """Name of each material."""
        return self._core.materials

    @property
    def lights(self) -> list[dict[str, Any]]:
        """Each light that can be chosen: kind, place, mean emission, share of the power of all."""
        return self._core.lights

    @property
    def primitives(self) -> tuple[int, int, int]:
        """How many spheres, quads and triangles there are, those of prototypes counted once."""
        return self._core.primitives

    @property
    def notices(self) -> list[str]:
        return self._core.notices

    # ---- rays ----

    def intersect(self, origins: np.ndarray, directions: np.ndarray, t_max: Any = math.inf, time: Any = 0.0) -> Hits:
        """The nearest surface along each ray, (N, 3) origins and unit directions, below t_max, one number or (N,).
        time: (N,) in [0, 1) of the shutter. Surfaces that let a part of rays through count as others."""
        return Hits(*_core.intersect(self._core, origins, directions, t_max, time))

    def occluded(self, origins: np.ndarray, directions: np.ndarray, t_max: Any = math.inf,
                 time: Any = 0.0) -> np.ndarray:
        """(N,) bool: whether anything lies on each ray below t_max."""
        return _core.occluded(self._core, origins, directions, t_max, time)

    def camera_rays(self, x: Any, y: Any, u_pixel: np.ndarray = _CENTRE,
                    u_lens: np.ndarray = _CENTRE) -> tuple[np.ndarray, np.ndarray]:
        """Origins and unit directions, (N, 3) each, of rays through the pixels x, y (uint32, from the upper left one),
        at the place u_pixel in the pixel and u_lens on the lens, (N, 2) each."""
        return _core.camera_rays(self._core, x, y, u_pixel, u_lens)

    # ---- lights ----

    def sample_light(self, light: int, points: np.ndarray, normals: np.ndarray | None, u: np.ndarray,
                     time: Any = 0.0) -> LightSamples:
        """A direction to one light from each of (N, 3) points by (N, 2) numbers u, by the strategy that the flags
        sphere_light, quad_light and triangle_light name. normals: (N, 3), or None in a medium. Sources: Arvo 1995 and
        Peters 2021 (triangles), Urena et al. 2013 (rectangles), docs/light-sampling.md."""
        return LightSamples(*_core.sample_light(self._core, light, points, _normals(normals), u, time))

    def light_pdf(self, light: int, points: np.ndarray, normals: np.ndarray | None, directions: np.ndarray,
                  time: Any = 0.0) -> np.ndarray:
        """(N,) density per steradian with which sample_light gives (N, 3) directions; 0 where they miss the light."""
        return _core.light_pdf(self._core, light, points, _normals(normals), directions, time)

    def choose_light(self, points: np.ndarray, normals: np.ndarray | None,
                     u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Index (N,) int32 of the light that is chosen at each point by u (N, 2), and its probability (N,), by the flag
        light_selection. -1: no light can contribute."""
        return _core.choose_light(self._core, points, _normals(normals), u)

    def light_probability(self, light: int, points: np.ndarray, normals: np.ndarray | None) -> np.ndarray:
        """(N,) probability with which choose_light chooses this light."""
        return _core.light_probability(self._core, light, points, _normals(normals))

    def light_sampling_pdf(self, points: np.ndarray, normals: np.ndarray | None, directions: np.ndarray,
                           time: Any = 0.0) -> np.ndarray:
        """(N,) density per steradian of choosing a light and sampling it: the sum over all lights that the direction
        meets. What lies in between does not count."""
        return _core.light_sampling_pdf(self._core, points, _normals(normals), directions, time)

    # ---- scattering ----

    def sample_bsdf(self, material: int | str, normals: np.ndarray, wo: np.ndarray, u: np.ndarray,
                    uv: np.ndarray = _CENTRE) -> BsdfSamples:
        """A scattered direction by (N, 2) numbers u, for light that leaves along wo (N, 3, unit, away from the surface)
        from a flat surface of the material, an index or a name, with normals (N, 3) on its front."""
        return BsdfSamples(*_core.sample_bsdf(self._core, self._material(material), normals, wo, u, uv))

    def eval_bsdf(self, material: int | str, normals: np.ndarray, wo: np.ndarray, wi: np.ndarray,
                  uv: np.ndarray = _CENTRE) -> tuple[np.ndarray, np.ndarray]:
        """Value * |cosine| (N, 3) and density per steradian (N,) with which sample_bsdf gives wi; 0 of delta lobes, and
        below the surface."""
        return _core.eval_bsdf(self._core, self._material(material), normals, wo, wi, uv)

    def _material(self, material: int | str) -> int:
        if isinstance(material, str):
            if material not in self.materials:
                raise ValueError(f"material: expected one of {', '.join(self.materials)}; got {material}")
            return self.materials.index(material)
        return material

    # ---- random numbers ----

    def samples(self, pixel: Any, sample: Any, dimension: Any, replicate: Any = 0) -> np.ndarray:
        """(N, 2) random numbers of the renderers, by the flags sampler, spp, seed and width: of pixels (numbered row by
        row), samples and dimensions, each one number or uint32 (N,). Owen-scrambled Sobol (Laine & Karras 2011),
        jittered strata (Kensler 2013), blue noise (Ahmed & Wonka 2020), pcg3d (Jarzynski & Olano 2020)."""
        return _core.samples(self._core, pixel, sample, dimension, replicate)


def _normals(normals: np.ndarray | None) -> np.ndarray:
    return _ORIGIN if normals is None else normals


class Scene(collections.abc.MutableMapping):
    """A scene as a nested dict with the names of Assets/scene.schema.json; docs/scene-files.md describes them.

    scene["camera"]["vertical_fov"] = 30 edits it, and the next render or compile() takes it as it is then.
    """

    def __init__(self, source: Source, name: str = "scene") -> None:
        self._data: dict[str, Any] | None = None
        self._source: str | None = None
        self._folder = "."
        self._name = name
        self._last: tuple[Any, _core.Compiled] | None = None
        if isinstance(source, Scene):
            self.__dict__.update(copy.deepcopy({k: v for k, v in source.__dict__.items() if k != "_last"}), _last=None)
        elif isinstance(source, dict):
            self._data = source
        else:
            if not isinstance(source, (str, bytes, os.PathLike)):
                raise TypeError(f"scene: expected an id, a file, a dict or a Scene; got {type(source).__name__}")
            self._source = self._name = _arguments.file("scene", source)
            if os.path.exists(self._source):
                self._folder = os.path.dirname(os.path.abspath(self._source))

    @property
    def data(self) -> dict[str, Any]:
        """The dict itself, for json.dump and the like."""
        if self._data is None:
            self._data = json.loads(_core.scene_text(self._source))
        return self._data

    def __getitem__(self, key: str) -> Any:
        return self.data[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self.data[key] = value

    def __delitem__(self, key: str) -> None:
        del self.data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self.data)

    def __len__(self) -> int:
        return len(self.data)

    def __repr__(self) -> str:
        return f"<raytracing.Scene {self._name!r}>"

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes a scene file; what was there stays unless all of it can be written. Raises TypeError, or InputError,
        naming the place in the scene, RenderError for the file."""
        text = json.dumps(json.loads(to_json(self.data, self._name)), indent=2) + "\n"
        _core.replace_file(_arguments.file("file", file), text)

    def compile(self, **flags: Any) -> Compiled:
        """The scene as it is now, for the flags that render() takes: the camera, the size of the image, strategies of
        light sampling and the sampler are theirs. Raises InputError naming the place in the scene, UsageError naming
        the flag."""
        return Compiled(self._compile(_flags.options("cpu", flags)))

    def _compile(self, options: _core.Options) -> _core.Compiled:
        text = None if self._data is None else to_json(self._data, self._name)
        key = (text, options.one_sided_lights, options.camera, options.assets_below)
        if self._last is not None and self._last[0] == key:
            return self._last[1].with_options(options)
        if text is None:
            compiled = _core.compile_source(self._source, options)
        else:
            compiled = _core.compile_text(text, self._name, self._folder, options)
        self._last = (key, compiled)
        if not options.quiet:
            for notice in compiled.notices:
                warnings.warn(f"{compiled.id}: {notice}", Notice, stacklevel=4)
        return compiled


def load(source: Source) -> Scene:
    """A scene: the id of a built-in one (see scenes()), a file (.json, .obj, .gltf, .glb, .pbrt), or a dict that is
    laid out like a scene file. A dict is not copied: edit it, or the scene, and render again. A name that is neither an
    id nor a file is an error at once; what is in a file or a dict is read when it is needed."""
    scene = Scene(source)
    is_name = scene._source is not None and not os.path.isfile(scene._source)
    if is_name and not any(row["id"] == scene._source for row in scenes()):
        scene.compile()
    return scene


def scenes() -> list[dict[str, str]]:
    """The built-in scenes: id, title and description of each."""
    return json.loads(_core.list_scenes())


def light(shape: dict[str, Any], emission: Any = (1.0, 1.0, 1.0), sides: str = "front", **flags: Any) -> Compiled:
    """A scene of one light: shape is an object of a scene file without its material, such as {"type": "sphere",
    "center": [0, 2, 0], "radius": 1}. sample_light(0, ...) and light_pdf(0, ...) sample it; a mesh has a light for each
    triangle."""
    _arguments.instance("shape", shape, collections.abc.Mapping, "a dict, an object of a scene file")
    _arguments.instance("emission", emission, (list, tuple, np.ndarray), "three numbers")
    lamp = {"type": "emitter", "emission": emission, "sides": sides}
    data = {"materials": {"lamp": lamp}, "objects": [{**shape, "material": "lamp"}]}
    return Scene(data, "light").compile(**flags)


def material(description: dict[str, Any], textures: dict[str, Any] | None = None, **flags: Any) -> Compiled:
    """A scene of one surface: description is a material of a scene file, such as {"type": "metal", "albedo": [0.8, 0.8,
    0.8], "fuzz": 0.1}. sample_bsdf("material", ...) and eval_bsdf("material", ...) scatter at it."""
    _arguments.instance("description", description, collections.abc.Mapping, "a dict, a material of a scene file")
    quad = {"type": "quad", "corner": [0, 0, -1], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0], "material": "material"}
    data = {"textures": textures or {}, "materials": {"material": dict(description)}, "objects": [quad]}
    return Scene(data, "material").compile(**flags)


def samples(pixel: Any, sample: Any, dimension: Any, replicate: Any = 0, **flags: Any) -> np.ndarray:
    """Compiled.samples() without a scene: samples(0, numpy.arange(16, dtype="uint32"), 0, sampler="sobol", spp=16)."""
    ball = {"type": "sphere", "center": [0, 0, -2], "radius": 1, "material": "m"}
    data = {"materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}}, "objects": [ball]}
    return Scene(data, "samples").compile(**flags).samples(pixel, sample, dimension, replicate)


#: Numbers of sample dimensions: of the camera; "camera_dimensions" is where those of vertices begin, "per_vertex" each.
DIMENSIONS: dict[str, int] = dict(_core.sample_dimensions)
