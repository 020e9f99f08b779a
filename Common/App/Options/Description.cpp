#include "Common/App/Options/Description.h"

#include <vector>

#include "Common/App/Options/Options.h"

namespace rt::app {

void describeProgram(FlagSet& flags, const std::string& program) {
    const bool isGpu = program == kGpuProgram;
    const std::string processor = isGpu ? "--device" : "--threads";
    std::vector<manual::Term> environment = {
        {"RT_ASSETS", "folder of scenes, models and textures, in place of the one that comes with the program"},
        {isGpu ? "RT_DEVICE" : "RT_THREADS", "stands for " + processor + " where the command line lacks it"},
        {"RT_LOG", "trace, debug, info, warn, error or off: how much is logged"},
        {"XDG_CONFIG_HOME", "ray-tracing/ in it holds settings of the window, and config.toml: defaults of flags"}};
    if (isGpu) environment.push_back({"VK_DRIVER_FILES", "Vulkan drivers to use, in place of those of the system"});
    const std::vector<manual::Term> examples = {
        {program, "Open a window with the default scene."},
        {program + " --scene one-weekend-final --spp 256 -o spheres.png", "Render a picture without a window."},
        {program + " --scene veach-mis --target-error 0.01 -o veach.exr --denoise",
         "Render until the estimated error is small enough, and write a denoised picture as well."},
        {program + " --list-scenes", "Tell which scenes there are."}};
    flags.describe({"--scene", "--list-scenes", "--width", "--height", "--spp", "--light-sampling", "--output",
                    "--denoise", "--target-error", "--time-limit", processor, "--headless"},
                   examples, environment);
}

} // namespace rt::app
