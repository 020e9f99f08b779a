#include "Common/Gui/Panels/Chart.h"

#include <algorithm>
#include <cmath>

#include "Common/Core/Format.h"

namespace rt::gui {
namespace {

constexpr float kLegendMark = 1; // what a mark in the legend takes of the line, in heights of the font

struct Axis {
    double low = 1e300, high = 0; // log10 after settle()

    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    // Whole decades, at least one.
    void settle() {
        if (!(high > 0)) low = 0.1, high = 1;
        low = std::floor(std::log10(low));
        high = std::ceil(std::log10(high));
        if (high <= low) high = low + 1;
    }
    float at(double value) const { return static_cast<float>((std::log10(value) - low) / (high - low)); }
};

bool isShown(const std::pair<double, double>& point) {
    return std::isfinite(point.first) && std::isfinite(point.second) && point.first > 0 && point.second > 0;
}

std::string decadeText(int exponent) {
    if (exponent >= -2 && exponent <= 3) return formatted("%g", std::pow(10.0, exponent));
    return formatted("1e%d", exponent);
}

class Plot {
  public:
    Plot(ImVec2 corner, ImVec2 size, Axis x, Axis y) : corner_(corner), size_(size), x_(x), y_(y) {}

    ImVec2 at(const std::pair<double, double>& point) const {
        return {corner_.x + size_.x * x_.at(point.first), corner_.y + size_.y * (1 - y_.at(point.second))};
    }

    void drawGrid(ImDrawList& list) const {
        const ImU32 line = ImGui::GetColorU32(ImGuiCol_Separator);
        const ImU32 faint = ImGui::GetColorU32(ImGuiCol_Separator, 0.35f);
        const ImU32 text = ImGui::GetColorU32(ImGuiCol_TextDisabled);
        // Labels keep clear of one another.
        const int everyX = std::max(1, static_cast<int>(std::ceil((x_.high - x_.low) * 42 / std::max(size_.x, 1.0f))));
        const int everyY = std::max(
            1, static_cast<int>(std::ceil((y_.high - y_.low) * 1.3f * ImGui::GetFontSize() / std::max(size_.y, 1.0f))));
        for (int e = static_cast<int>(x_.low); e <= static_cast<int>(x_.high); ++e) {
            const float x = corner_.x + size_.x * static_cast<float>((e - x_.low) / (x_.high - x_.low));
            list.AddLine({x, corner_.y}, {x, corner_.y + size_.y}, e == x_.low ? line : faint);
            if ((e - static_cast<int>(x_.low)) % everyX != 0) continue;
            const std::string label = decadeText(e);
            const float below = 0.4f * ImGui::GetFontSize(); // of the lowest label at the left
            list.AddText({x - 0.5f * ImGui::CalcTextSize(label.c_str()).x, corner_.y + size_.y + below}, text,
                         label.c_str());
        }
        for (int e = static_cast<int>(y_.low); e <= static_cast<int>(y_.high); ++e) {
            const float y = corner_.y + size_.y * (1 - static_cast<float>((e - y_.low) / (y_.high - y_.low)));
            list.AddLine({corner_.x, y}, {corner_.x + size_.x, y}, e == y_.low ? line : faint);
            if ((e - static_cast<int>(y_.low)) % everyY != 0) continue;
            const std::string label = decadeText(e);
            const ImVec2 extent = ImGui::CalcTextSize(label.c_str());
            list.AddText({corner_.x - extent.x - 4, y - 0.5f * extent.y}, text, label.c_str());
        }
    }

    void drawSeries(ImDrawList& list, const ChartSeries& series) const {
        const float radius = (series.isStressed ? 0.34f : 0.22f) * ImGui::GetFontSize();
        const ImVec2* before = nullptr;
        ImVec2 last;
        for (const auto& point : series.points) {
            if (!isShown(point)) continue;
            const ImVec2 p = at(point);
            if (series.mark != Mark::Line) {
                drawMark(list, series.mark, p, radius, series.color, series.isHollow);
                if (series.isStressed) list.AddCircle(p, 1.7f * radius, ImGui::GetColorU32(ImGuiCol_Text));
            } else {
                if (before != nullptr) list.AddLine(*before, p, series.color, 0.12f * ImGui::GetFontSize());
                last = p;
                before = &last;
            }
        }
    }

    // The id of the point nearest to the pointer, if it is near.
    std::optional<std::size_t> nearest(const std::vector<ChartSeries>& series, ImVec2 pointer) const {
        float minimum = 0.8f * ImGui::GetFontSize();
        std::optional<std::size_t> found;
        for (const ChartSeries& s : series) {
            if (!s.id) continue;
            for (const auto& point : s.points) {
                if (!isShown(point)) continue;
                const ImVec2 p = at(point);
                const float distance = std::hypot(p.x - pointer.x, p.y - pointer.y);
                if (distance >= minimum) continue;
                minimum = distance;
                found = s.id;
            }
        }
        return found;
    }

  private:
    ImVec2 corner_, size_;
    Axis x_, y_;
};

// The legend is above the plot, where there are no points: entries from left to right, in as many lines as they need.
struct LegendLayout {
    std::vector<ImVec2> places; // of the entries
    float bottom = 0;
};

// Entries fit between `left` and `right`; those of the first line follow a label that ends at `labelEnd`.
LegendLayout layOutLegend(const std::vector<ChartLegendRow>& rows, float left, float labelEnd, float right, float top) {
    const float em = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    LegendLayout layout;
    ImVec2 at{labelEnd + em, top};
    for (const ChartLegendRow& row : rows) {
        const float width = kLegendMark * em + ImGui::CalcTextSize(row.text.c_str()).x;
        if (at.x + width > right && at.x > left) at = {left, at.y + line};
        layout.places.push_back(at);
        at.x += width + em;
    }
    layout.bottom = at.y + line;
    return layout;
}

void drawLegend(ImDrawList& list, const std::vector<ChartLegendRow>& rows, const LegendLayout& layout) {
    const float em = ImGui::GetFontSize();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const ChartLegendRow& row = rows[i];
        const ImVec2 place = layout.places[i];
        const ImVec2 middle{place.x + 0.4f * em, place.y + 0.5f * em};
        if (row.mark == Mark::Line) {
            list.AddLine({middle.x - 0.4f * em, middle.y}, {middle.x + 0.3f * em, middle.y}, row.color, 0.12f * em);
        } else {
            drawMark(list, row.mark, middle, 0.25f * em, row.color, row.isHollow);
        }
        list.AddText({place.x + kLegendMark * em, place.y}, ImGui::GetColorU32(ImGuiCol_Text), row.text.c_str());
    }
}

} // namespace

void drawMark(ImDrawList& list, Mark mark, ImVec2 at, float radius, ImU32 color, bool isHollow) {
    const float line = 0.35f * radius;
    if (mark == Mark::Circle) {
        isHollow ? list.AddCircle(at, radius, color, 0, line) : list.AddCircleFilled(at, radius, color);
        return;
    }
    // Of about equal area.
    const float square = 0.89f * radius, diamond = 1.25f * radius;
    const ImVec2 squares[] = {{-square, -square}, {square, -square}, {square, square}, {-square, square}};
    const ImVec2 diamonds[] = {{0, -diamond}, {diamond, 0}, {0, diamond}, {-diamond, 0}};
    const ImVec2 triangles[] = {{0, -1.45f * radius}, {1.35f * radius, radius}, {-1.35f * radius, radius}};
    const ImVec2* corners = mark == Mark::Square ? squares : mark == Mark::Diamond ? diamonds : triangles;
    const int count = mark == Mark::Triangle ? 3 : 4;
    ImVec2 placed[4];
    for (int i = 0; i < count; ++i) placed[i] = {at.x + corners[i].x, at.y + corners[i].y};
    isHollow ? list.AddPolyline(placed, count, color, ImDrawFlags_Closed, line)
             : list.AddConvexPolyFilled(placed, count, color);
}

ChartPointer drawLogLogChart(const char* id, const char* xLabel, const char* yLabel,
                             const std::vector<ChartSeries>& series, const std::vector<ChartLegendRow>& legend,
                             ImVec2 size) {
    Axis x, y;
    bool any = false;
    for (const ChartSeries& s : series) {
        for (const auto& point : s.points) {
            if (!isShown(point)) continue;
            x.include(point.first);
            y.include(point.second);
            any = true;
        }
    }
    x.settle();
    y.settle();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float font = ImGui::GetFontSize();
    const float left = ImGui::CalcTextSize("1e-10").x + 6, bottom = 2.6f * font, right = size.x - 0.8f * font;
    const LegendLayout legendLayout = layOutLegend(
        legend, corner.x + left, corner.x + std::max(left, ImGui::CalcTextSize(yLabel).x), corner.x + right, corner.y);
    const auto topBelow = [font](float height) { return height + 0.3f * font; }; // half a label of the highest decade
    float top = topBelow(legendLayout.bottom - corner.y);
    const bool hasLegend = size.y >= bottom + top + 3 * font; // the points matter more
    if (!hasLegend) top = topBelow(ImGui::GetTextLineHeightWithSpacing());
    const bool isClicked = ImGui::InvisibleButton(id, {std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
    const bool isPointedAt = ImGui::IsItemHovered();
    if (size.x < left + 3 * font || size.y < bottom + top + 2 * font) return {}; // no room
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 inner{right - left, size.y - bottom - top};
    const Plot plot({corner.x + left, corner.y + top}, inner, x, y);
    plot.drawGrid(list);
    const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    list.AddText({corner.x, corner.y}, dim, yLabel);
    list.AddText({corner.x + left + inner.x - ImGui::CalcTextSize(xLabel).x, corner.y + size.y - 1.1f * font}, dim,
                 xLabel);
    if (!any) {
        const char* nothing = "no errors yet";
        const ImVec2 extent = ImGui::CalcTextSize(nothing);
        list.AddText({corner.x + left + 0.5f * (inner.x - extent.x), corner.y + top + 0.5f * (inner.y - extent.y)}, dim,
                     nothing);
        return {};
    }
    for (const ChartSeries& s : series) plot.drawSeries(list, s);
    if (hasLegend) drawLegend(list, legend, legendLayout);
    if (!isPointedAt) return {};
    return {plot.nearest(series, ImGui::GetIO().MousePos), isClicked};
}

} // namespace rt::gui
