#include "Common/Bench/Chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "Common/Bench/Markup.h"
#include "Common/Core/Format.h"

namespace rt::bench {
namespace {

constexpr double kWidth = 560, kPlotHeight = 300;
constexpr double kLeft = 64, kRight = 14, kTop = 30, kBottom = 44;
constexpr double kLegendLine = 17;

// Okabe and Ito's colours, told apart by every kind of colour vision; dashes and marks tell lines apart without them.
constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#444444"};
constexpr std::array kDashes = {"", "6 3", "2 3", "9 3 2 3"};

struct Scale { // of one axis, in powers of ten
    double low = 0, high = 1;
    double from = 0, to = 1; // in the picture

    double operator()(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

std::string number(double value) {
    return formatted("%.1f", value);
}

class SvgWriter {
  public:
    explicit SvgWriter(double height) {
        text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " + number(height) +
                "\" width=\"" + number(kWidth) + "\" height=\"" + number(height) +
                "\" font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<rect width=\"100%\" height=\"100%\" "
                "fill=\"#fff\"/>\n";
    }

    void line(double x0, double y0, double x1, double y1, const std::string& style) {
        text_ += "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" +
                 number(y1) + "\" " + style + "/>\n";
    }
    void text(double x, double y, const std::string& content, const std::string& style) {
        text_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" fill=\"#222\" " + style + ">" +
                 escapeMarkup(content) + "</text>\n";
    }
    void polyline(const std::vector<std::pair<double, double>>& points, const std::string& style) {
        text_ += "<polyline fill=\"none\" points=\"";
        for (const auto& [x, y] : points) text_ += number(x) + "," + number(y) + " ";
        text_ += "\" " + style + "/>\n";
    }
    void dot(double x, double y, const std::string& color) {
        text_ += "<circle" + at(x, y, 2.8) + " fill=\"" + color + "\"/>\n";
    }
    // A dot within one that is not seen: large enough to be met.
    void linkedDot(double x, double y, const std::string& color, const std::string& link, const std::string& caption) {
        text_ += "<a href=\"" + escapeMarkup(link) + "\"><title>" + escapeMarkup(caption) + "</title><circle" +
                 at(x, y, 8) + " fill=\"transparent\" stroke=\"none\"/>";
        dot(x, y, color);
        text_ += "</a>\n";
    }
    std::string finish() { return text_ + "</svg>\n"; }

  private:
    static std::string at(double x, double y, double radius) {
        return " cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + number(radius) + "\"";
    }

    std::string text_;
};

std::string labelOf(int digit, int exponent) {
    if (exponent < -2 || exponent > 4) return std::to_string(digit) + "e" + std::to_string(exponent);
    return formatted("%g", digit * std::pow(10.0, exponent));
}

// Whole powers of ten, or halves of them where there is little to see.
void widen(Scale& scale) {
    scale.low = std::floor(scale.low * 2 - 0.05) / 2;
    scale.high = std::ceil(scale.high * 2 + 0.05) / 2;
}

void drawAxes(SvgWriter& svg, const Chart& chart, const Scale& x, const Scale& y) {
    const std::string grid = "stroke=\"#ddd\"", faint = "stroke=\"#f2f2f2\"";
    for (const bool horizontal : {true, false}) {
        const Scale& scale = horizontal ? x : y;
        const bool wide = scale.high - scale.low > 6;    // no room for all labels
        const bool narrow = scale.high - scale.low <= 2; // room for some between
        for (int e = static_cast<int>(std::floor(scale.low)); e <= static_cast<int>(std::ceil(scale.high)); ++e)
            for (int digit = 1; digit < 10; ++digit) {
                const double exponent = e + std::log10(digit);
                if (exponent < scale.low - 1e-9 || exponent > scale.high + 1e-9) continue;
                const double at = scale(std::pow(10.0, exponent));
                const std::string& style = digit == 1 ? grid : faint;
                horizontal ? svg.line(at, y.from, at, y.to, style) : svg.line(x.from, at, x.to, at, style);
                const bool labelled = digit == 1 ? !wide || e % 2 == 0 : narrow && (digit == 2 || digit == 5);
                if (!labelled) continue;
                horizontal ? svg.text(at, y.from + 16, labelOf(digit, e), "text-anchor=\"middle\"")
                           : svg.text(x.from - 6, at + 4, labelOf(digit, e), "text-anchor=\"end\"");
            }
    }
    svg.line(x.from, y.from, x.to, y.from, "stroke=\"#888\"");
    svg.line(x.from, y.from, x.from, y.to, "stroke=\"#888\"");
    svg.text((x.from + x.to) / 2, y.from + 36, chart.xTitle, "text-anchor=\"middle\"");
    svg.text(x.from - 50, y.to - 10, chart.yTitle, "");
    svg.text((x.from + x.to) / 2, 16, chart.title, "text-anchor=\"middle\" font-weight=\"bold\"");
}

void drawLegend(SvgWriter& svg, const std::string& name, std::size_t index, const Scale& y, const std::string& style) {
    const double at = y.from + kBottom + kLegendLine * static_cast<double>(index);
    svg.line(kLeft, at - 4, kLeft + 26, at - 4, style);
    svg.text(kLeft + 32, at, name, "");
}

using LinkOf = std::function<std::string(Origin)>;

void drawPoint(SvgWriter& svg, const ChartPoint& point, const std::string& color, const Scale& x, const Scale& y,
               const LinkOf& linkOf) {
    if (point.error > 0) {
        const double low = std::max(point.y - point.error, std::pow(10.0, y.low));
        svg.line(x(point.x), y(low), x(point.x), y(std::min(point.y + point.error, std::pow(10.0, y.high))),
                 "stroke=\"" + color + "\" stroke-opacity=\"0.5\"");
    }
    const std::string link = linkOf && point.origin != nullptr ? linkOf(point.origin) : "";
    if (link.empty())
        svg.dot(x(point.x), y(point.y), color);
    else
        svg.linkedDot(x(point.x), y(point.y), color, link, point.caption);
}

void drawLine(SvgWriter& svg, const ChartLine& line, std::size_t index, const Scale& x, const Scale& y,
              const LinkOf& linkOf) {
    const std::string color = kColors[index % kColors.size()];
    const std::string dash = kDashes[index / kColors.size() % kDashes.size()];
    std::vector<std::pair<double, double>> points;
    points.reserve(line.points.size());
    for (const ChartPoint& p : line.points) points.emplace_back(x(p.x), y(p.y));
    svg.polyline(points, "stroke=\"" + color + "\" stroke-width=\"1.6\"" +
                             (dash.empty() ? "" : " stroke-dasharray=\"" + dash + "\""));
    for (const ChartPoint& p : line.points) drawPoint(svg, p, color, x, y, linkOf); // above the line
    drawLegend(
        svg, line.name, index, y,
        "stroke=\"" + color + "\" stroke-width=\"2\"" + (dash.empty() ? "" : " stroke-dasharray=\"" + dash + "\""));
}

// Through the first point of the first line.
void drawGuide(SvgWriter& svg, const ChartLine& line, std::size_t index, const Scale& x, const Scale& y) {
    const std::string style = "stroke=\"#999\" stroke-dasharray=\"1 4\"";
    const double start = std::log10(line.points.front().y) + std::log10(line.points.front().x);
    const double from = std::max(x.low, start - y.high), to = std::min(x.high, start - y.low);
    if (!(to > from)) return;
    svg.line(x(std::pow(10.0, from)), y(std::pow(10.0, start - from)), x(std::pow(10.0, to)),
             y(std::pow(10.0, start - to)), style);
    drawLegend(svg, "slope −1", index, y, style);
}

} // namespace

std::string toSvg(const Chart& original, const LinkOf& linkOf) {
    Chart chart = original;
    Scale x{1e9, -1e9, kLeft, kWidth - kRight};
    Scale y{1e9, -1e9, kTop + kPlotHeight, kTop + 14};
    for (ChartLine& line : chart.lines) {
        std::erase_if(line.points, [](const ChartPoint& p) {
            return !(p.x > 0) || !(p.y > 0) || !std::isfinite(p.x) || !std::isfinite(p.y);
        });
        for (const ChartPoint& p : line.points) {
            x.low = std::min(x.low, std::log10(p.x));
            x.high = std::max(x.high, std::log10(p.x));
            y.low = std::min(y.low, std::log10(p.y));
            y.high = std::max(y.high, std::log10(p.y));
        }
    }
    std::erase_if(chart.lines, [](const ChartLine& line) { return line.points.empty(); });
    if (chart.lines.empty()) return {};
    widen(x);
    widen(y);
    const std::size_t legends = chart.lines.size() + (chart.minusOne ? 1 : 0);
    SvgWriter svg(kTop + kPlotHeight + kBottom + kLegendLine * static_cast<double>(legends));
    drawAxes(svg, chart, x, y);
    if (chart.minusOne) drawGuide(svg, chart.lines.front(), chart.lines.size(), x, y);
    for (std::size_t i = 0; i < chart.lines.size(); ++i) drawLine(svg, chart.lines[i], i, x, y, linkOf);
    return svg.finish();
}

} // namespace rt::bench
