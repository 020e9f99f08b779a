#include "Common/Gui/Inspector.h"

#include <utility>

#include "Common/Core/Format.h"

namespace rt::gui {
namespace {

std::string nameOf(app::Legend::Quantity quantity) {
    using Quantity = app::Legend::Quantity;
    switch (quantity) {
        case Quantity::Time:
            return "time a sample";
        case Quantity::StandardError:
            return "relative noise";
        case Quantity::Error:
            return "relative error";
        case Quantity::DenoisedError:
            return "denoised error";
        case Quantity::Bandwidth:
            return "bandwidth";
        case Quantity::Distance:
            return "distance";
        case Quantity::Rays:
            break;
    }
    return "rays a sample";
}

} // namespace

std::vector<InspectedRow> inspectPixel(const app::Picture& picture, const image::Image* held,
                                       const std::array<std::uint32_t, 2>& pixel) {
    const std::uint32_t x = pixel[0], y = pixel[1];
    const auto find = [x, y](const image::Image* image) {
        return image != nullptr && x < image->width && y < image->height ? image->pixel(x, y) : nullptr;
    };
    const float* rgb = find(picture.radiance.get());
    const float* seen = find(picture.subject.get());
    if (rgb == nullptr || seen == nullptr) return {};
    constexpr const char* kPattern = "%.4g  %.4g  %.4g";
    std::vector<InspectedRow> rows = {{"pixel", formatted("%u, %u", x, y), "", ""}};
    // What is seen is compared with what was pinned, though the radiance may be another picture.
    InspectedRow shown{"radiance", formatted(kPattern, seen[0], seen[1], seen[2]), "", ""};
    if (const float* other = find(held)) {
        rows.front() = {"pixel", "B: picture", "A: pinned", "B - A"};
        rows.push_back({"", formatted("%u, %u", x, y), "", ""});
        shown.held = formatted(kPattern, other[0], other[1], other[2]);
        shown.difference = formatted("%+.3g  %+.3g  %+.3g", seen[0] - other[0], seen[1] - other[1], seen[2] - other[2]);
    }
    if (const float* value = find(picture.values.get()))
        rows.push_back({picture.legend ? nameOf(picture.legend->quantity) : "view",
                        picture.values->channels == 1 ? formatted("%.4g", *value)
                                                      : formatted(kPattern, value[0], value[1], value[2]),
                        "", ""});
    if (picture.subject != picture.radiance) {
        shown.name = picture.isDenoised ? "denoised" : "half";
        rows.push_back(std::exchange(shown, {"radiance", formatted(kPattern, rgb[0], rgb[1], rgb[2]), "", ""}));
    }
    rows.push_back(std::move(shown));
    if (const float* variance = find(picture.variance.get()))
        rows.push_back({"variance", formatted("%.3g  %.3g  %.3g", variance[0], variance[1], variance[2]), "", ""});
    if (const float* samples = find(picture.samples.get()))
        rows.push_back({"samples", formatted("%.0f", *samples), "", ""});
    return rows;
}

std::vector<InspectedRow> stacked(const std::vector<InspectedRow>& rows) {
    std::vector<InspectedRow> below;
    for (const InspectedRow& row : rows) {
        const InspectedRow& titles = rows.front();
        const std::string& name = row.name.empty() ? titles.name : row.name;
        if (row.held.empty()) {
            below.push_back({name, row.picture, "", ""});
        } else if (&row != &titles) {
            below.push_back({name + ", " + titles.picture, row.picture, "", ""});
            below.push_back({name + ", " + titles.held, row.held, "", ""});
            below.push_back({name + ", " + titles.difference, row.difference, "", ""});
        }
    }
    return below;
}

} // namespace rt::gui
