"""Headers of libraries from this system, for a compiler of another: by links in a folder of their own, so that those of
this system's C library are not in sight."""
from pathlib import Path

NAMES = ["glm", "spdlog", "fmt", "nlohmann", "CLI", "tiny_gltf.h", "vulkan", "vk_video", "GLFW", "imgui", "png*.h",
         "jpeglib.h", "jmorecfg.h", "jerror.h", "zlib.h", "zconf.h", "OpenEXR", "Imath", "tiff*.h", "webp", "stb",
         "x86_64-linux-gnu/jconfig.h", "x86_64-linux-gnu/tiff*.h", "x86_64-linux-gnu/zconf.h", "libpng16"]


def link_all(folder):
    for name in NAMES:
        for header in Path("/usr/include").glob(name):
            link = Path(folder, header.name)
            if not link.exists():
                link.symlink_to(header)
    return folder
