// What the programs call of Open Image Denoise 2. Its filter only mixes what it was given, so that a test sees that all
// of it arrived: a quarter of the colour, half of the albedo, and |normal| / 8.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>

#ifdef _WIN32
#define EXPORTED extern "C" __declspec(dllexport)
#else
#define EXPORTED extern "C"
#endif

namespace {

struct Filter {
    std::map<std::string, float*> images;
    std::size_t values = 0;
    bool isHdr = false, isCommitted = false;
};

const char* g_error = nullptr;
int g_device;

} // namespace

EXPORTED void* oidnNewDevice(int) {
    return &g_device;
}
EXPORTED void oidnReleaseDevice(void*) {}
EXPORTED void oidnCommitDevice(void*) {}
EXPORTED int oidnGetDeviceInt(void*, const char* name) {
    return std::strcmp(name, "versionMajor") == 0 ? 2 : std::strcmp(name, "versionMinor") == 0 ? 9 : 7;
}
EXPORTED int oidnGetDeviceError(void*, const char** message) {
    *message = g_error;
    return g_error == nullptr ? 0 : 1;
}
EXPORTED void* oidnNewFilter(void*, const char*) {
    return new Filter;
}
EXPORTED void oidnReleaseFilter(void* filter) {
    delete static_cast<Filter*>(filter);
}
EXPORTED void oidnSetSharedFilterImage(void* filter, const char* name, void* values, int format, std::size_t width,
                                       std::size_t height, std::size_t, std::size_t, std::size_t) {
    if (format != 3) g_error = "not three floats";
    static_cast<Filter*>(filter)->images[name] = static_cast<float*>(values);
    static_cast<Filter*>(filter)->values = 3 * width * height;
}
EXPORTED void oidnSetFilterBool(void* filter, const char* name, bool value) {
    static_cast<Filter*>(filter)->isHdr = value && std::strcmp(name, "hdr") == 0;
}
EXPORTED void oidnCommitFilter(void* filter) {
    static_cast<Filter*>(filter)->isCommitted = true;
}
EXPORTED void oidnExecuteFilter(void* filter) {
    Filter& f = *static_cast<Filter*>(filter);
    if (!f.isHdr || !f.isCommitted || f.images.size() != 4) {
        g_error = "not as it should be called";
        return;
    }
    for (std::size_t i = 0; i < f.values; ++i)
        f.images["output"][i] =
            f.images["color"][i] / 4 + f.images["albedo"][i] / 2 + std::abs(f.images["normal"][i]) / 8;
}
