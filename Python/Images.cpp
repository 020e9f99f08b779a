// Image files, metrics and tone curves.
#include <cmath>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>

#include "Common/App/Options/OptionValues.h"
#include "Common/Image/Display.h"
#include "Common/Image/Flip.h"
#include "Common/Image/ImageIo.h"
#include "Common/Image/ImageRows.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Names.h"
#include "Common/Shared/Tonemap.h"
#include "Python/Activity.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"

namespace rt::python {
namespace {

namespace py = pybind11;

py::array readArray(const std::string& file, const std::string& layer) {
    image::Image image;
    {
        const Released released;
        image = image::readImage(file, layer);
    }
    return toArray(std::move(image));
}

void writeArray(const std::string& file, const py::object& argument, const std::string& description) {
    const image::Image image = toImage(argument, "image");
    const Released released;
    image::writeImage(file, image, description);
}

py::dict metrics(const py::object& argument, const py::object& other) {
    const image::Image image = toImage(argument, "image");
    const image::Image reference = toImage(other, "reference");
    image::ErrorFigures figures;
    {
        const Released released;
        figures = image::compare(image, reference);
    }
    py::dict result;
    result["mse"] = figures.mse;
    result["rmse"] = figures.rmse;
    result["relmse"] = figures.relmse;
    result["mae"] = figures.mae;
    result["psnr"] = figures.psnr;
    result["max_abs"] = figures.maxAbs;
    return result;
}

py::array flipArray(const py::object& argument, const py::object& other, double pixelsPerDegree) {
    const image::Image image = toImage(argument, "image");
    const image::Image reference = toImage(other, "reference");
    if (!(pixelsPerDegree >= 1 && pixelsPerDegree <= 1e4))
        throw py::value_error("pixels_per_degree: expected a number from 1 to 10000; got " +
                              std::string(py::str(py::float_(pixelsPerDegree))));
    image::Image map;
    {
        const Released released;
        map = image::flipMap(image, reference, pixelsPerDegree);
    }
    return toArray(std::move(map));
}

// As flags of the same names: out of range is the same error.
py::array tonemap(const py::object& argument, double exposure, const std::string& curve, bool isEncoded) {
    const auto stops =
        app::parseReal("--exposure", py::str(py::float_(exposure)), -100, 100, "a number from -100 to 100");
    const auto row = static_cast<std::uint32_t>(app::parseChoice("--tonemap", curve, app::kTonemaps));
    const image::Image image = toImage(argument, "image");
    image::Image shown;
    {
        const Released released;
        shown = image::toImage(image::toDisplay(image, static_cast<float>(stops), row));
        if (isEncoded)
            for (float& value : shown.data) value = shared::srgbEncode(value);
        for (float& value : shown.data) // as in a PNG file
            if (std::isnan(value)) value = 0;
    }
    return toArray(std::move(shown));
}

} // namespace

void bindImages(py::module_& module) {
    module.def("read_image", &readArray);
    module.def("write_image", &writeArray);
    module.def("metrics", &metrics);
    module.def("flip_map", &flipArray);
    module.def("tonemap", &tonemap);
    module.def("auto_exposure", [](const py::object& image) { return image::autoExposure(toImage(image, "image")); });
    module.attr("flip_pixels_per_degree") = image::kFlipPixelsPerDegree;
}

} // namespace rt::python
