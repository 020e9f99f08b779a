"""Two path tracers, on the CPU and on the GPU, from Python.

    import raytracing

    film = raytracing.render("cornell-box-lights", spp=64, width=300)
    film.image                                      # float32 (height, width, 3), linear radiance
    scene = raytracing.load("cornell-box-lights")   # a nested dict, as scene files are
    scene["camera"]["vertical_fov"] = 30
    raytracing.write_image("a.png", raytracing.tonemap(raytracing.render(scene).image, encode=False))

docs/python.md has more; print(raytracing.flags()) lists what render() takes.
"""

from . import _core

_core.find_assets_around(_core.__file__)

from ._core import Error, InputError, NoDeviceError, RenderError, UsageError
from ._film import Aovs, Film, Progressive, progressive, render
from ._flags import flags
from ._images import (auto_exposure, build, devices, flip, flip_map, metrics, read_image, sample_spherical_triangle,
                      tonemap, triangle_solid_angle, write_image)
from ._probe import Probe, pixel_paths, probe
from ._scene import (DIMENSIONS, BsdfSamples, Compiled, Hits, LightSamples, Notice, Scene, light, load, material,
                     samples, scenes)

__version__: str = _core.version
__all__ = [
    "DIMENSIONS", "Aovs", "BsdfSamples", "Compiled", "Error", "Film", "Hits", "InputError", "LightSamples",
    "NoDeviceError", "Notice", "Probe", "Progressive", "RenderError", "Scene", "UsageError", "auto_exposure", "build",
    "devices", "flags", "flip", "flip_map", "light", "load", "material", "metrics", "pixel_paths", "probe",
    "progressive", "read_image", "render", "sample_spherical_triangle", "samples", "scenes", "tonemap",
    "triangle_solid_angle", "write_image",
]
