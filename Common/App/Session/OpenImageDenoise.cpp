#include "Common/App/Session/OpenImageDenoise.h"

#include <cmath>
#include <cstddef>
#include <memory>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

#if defined(_WIN32)
constexpr const char* kLibrary = "OpenImageDenoise.dll";
#elif defined(__APPLE__)
constexpr const char* kLibrary = "libOpenImageDenoise.2.dylib";
#else
constexpr const char* kLibrary = "libOpenImageDenoise.so.2";
#endif

// Of its header oidn.h.
constexpr int kDeviceTypeCpu = 1;
constexpr int kFormatFloat3 = 3;
constexpr int kMajorVersion = 2;
using Handle = void*;

} // namespace

OpenImageDenoise::OpenImageDenoise(const std::filesystem::path& library)
    : library_{library.empty() ? kLibrary : library.string().c_str()} {
    auto* const newDevice = library_.find<Handle(int)>("oidnNewDevice");
    if (newDevice == nullptr)
        throw RenderError(name_ + " cannot be loaded: there is no " + (library.empty() ? kLibrary : library.string()) +
                          " here");
    auto* const getInt = library_.find<int(Handle, const char*)>("oidnGetDeviceInt"); // version 1 has another name
    if (getInt == nullptr) throw RenderError(name_ + ": version 2 is needed");
    const std::unique_ptr<void, void (*)(Handle)> device(newDevice(kDeviceTypeCpu),
                                                         call<void(Handle)>("oidnReleaseDevice"));
    const auto part = [&](const char* which) { return device ? getInt(device.get(), which) : 0; };
    if (part("versionMajor") != kMajorVersion) throw RenderError(name_ + ": version 2 is needed");
    name_ += " " + std::to_string(kMajorVersion) + "." + std::to_string(part("versionMinor")) + "." +
             std::to_string(part("versionPatch"));
}

template <class Function>
Function* OpenImageDenoise::call(const char* function) const {
    Function* const found = library_.find<Function>(function);
    if (found == nullptr) throw RenderError(name_ + ": lacks " + function);
    return found;
}

image::Image OpenImageDenoise::filter(image::Image radiance, image::Image albedo, image::Image normal) const {
    using Owned = std::unique_ptr<void, void (*)(Handle)>;
    const Owned device(call<Handle(int)>("oidnNewDevice")(kDeviceTypeCpu), call<void(Handle)>("oidnReleaseDevice"));
    const auto check = [&] {
        const char* message = nullptr;
        if (!device || call<int(Handle, const char**)>("oidnGetDeviceError")(device.get(), &message) != 0)
            throw RenderError(name_ + ": " + (message == nullptr ? "no device" : message));
    };
    check();
    call<void(Handle)>("oidnCommitDevice")(device.get());
    check();
    const Owned filter(call<Handle(Handle, const char*)>("oidnNewFilter")(device.get(), "RT"),
                       call<void(Handle)>("oidnReleaseFilter"));
    check();
    using SetImage =
        void(Handle, const char*, void*, int, std::size_t, std::size_t, std::size_t, std::size_t, std::size_t);
    const auto set = [&, setImage = call<SetImage>("oidnSetSharedFilterImage")](const char* name, image::Image& image) {
        setImage(filter.get(), name, image.data.data(), kFormatFloat3, image.width, image.height, 0, 0, 0);
    };
    for (float& value : radiance.data)
        if (!std::isfinite(value)) value = 0;
    image::Image output(radiance.width, radiance.height);
    set("color", radiance);
    set("albedo", albedo);
    set("normal", normal);
    set("output", output);
    call<void(Handle, const char*, bool)>("oidnSetFilterBool")(filter.get(), "hdr", true);
    call<void(Handle)>("oidnCommitFilter")(filter.get());
    check();
    call<void(Handle)>("oidnExecuteFilter")(filter.get());
    check();
    return output;
}

} // namespace rt::app
