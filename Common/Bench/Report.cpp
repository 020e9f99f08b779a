#include "Common/Bench/Report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <set>

#include "Common/Bench/Defaults.h"
#include "Common/Bench/ReportCharts.h"
#include "Common/Bench/ResultsJson.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"

namespace rt::bench {
namespace {

constexpr const char* kUnknown = "–";

std::string percent(double value, int digits = 1) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f %%", digits, 100 * value);
    return text;
}

std::string whole(const Figure& figure) {
    if (!figure) return kUnknown;
    char text[32];
    std::snprintf(text, sizeof text, "%.0f", *figure);
    return text;
}

Figure times(const Figure& figure, double factor) {
    return figure ? Figure(*figure * factor) : std::nullopt;
}

std::string seconds(const Row& row) {
    if (!row.seconds) return kUnknown;
    std::string text = threeDigits(row.seconds);
    if (row.repeats.value_or(1) > 1 && *row.seconds > 0)
        text += " ±" + percent((*row.secondsMax - *row.secondsMin) / 2 / *row.seconds, 0);
    return text;
}

std::string withInterval(const Figure& value, const Figure& half) {
    std::string text = threeDigits(value);
    if (value && half && *value > 0) text += " ±" + percent(*half / *value, 0);
    return text;
}

// ---- columns that show something -------------------------------------------------------------------------------------

template <class T>
struct Column {
    std::string header;
    std::function<std::string(const T&)> cell;
};

template <class T>
Table makeTable(const std::vector<Column<T>>& columns, const std::vector<const T*>& rows) {
    Table table;
    table.rows.resize(rows.size());
    for (const Column<T>& column : columns) {
        std::vector<std::string> cells;
        for (const T* row : rows) cells.push_back(column.cell(*row));
        if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell == kUnknown; })) continue;
        table.header.push_back(column.header);
        for (std::size_t i = 0; i < rows.size(); ++i) table.rows[i].push_back(cells[i]);
    }
    return table;
}

// Axes that have more than one value among the rows; scene and engine always, the height, which follows the width,
// never.
template <class T>
std::vector<Column<T>> axisColumns(const std::vector<const T*>& rows) {
    std::vector<Column<T>> columns;
    for (const Axis& axis : axes()) {
        std::set<std::string> values;
        for (const T* row : rows) values.insert(axis.get(row->config));
        if (axis.name == "height") continue;
        if (values.size() > 1 || axis.name == "scene" || axis.name == "engine")
            columns.push_back({std::string(axis.name), [&axis](const T& row) { return axis.get(row.config); }});
    }
    return columns;
}

template <class T>
void append(std::vector<Column<T>>& to, std::vector<Column<T>> more) {
    for (Column<T>& column : more) to.push_back(std::move(column));
}

Table rowTable(const std::vector<const Row*>& rows) {
    std::vector<Column<Row>> columns = axisColumns(rows);
    append<Row>(columns,
                {
                    {"threads", [](const Row& r) { return r.config.threads > 0 ? whole(r.threadsUsed) : kUnknown; }},
                    {"spp", [](const Row& r) { return whole(r.spp); }},
                    {"seconds", seconds},
                    {"M samples/s", [](const Row& r) { return threeDigits(times(r.samplesPerSecond, 1e-6)); }},
                    {"M rays/s", [](const Row& r) { return threeDigits(times(r.raysPerSecond, 1e-6)); }},
                    {"of ceiling", [](const Row& r) { return r.ceiling ? percent(*r.ceiling, 0) : kUnknown; }},
                    {"mse", [](const Row& r) { return withInterval(r.mse, r.mseCi); }},
                    {"relmse", [](const Row& r) { return withInterval(r.relmse, r.relmseCi); }},
                    {"psnr", [](const Row& r) { return threeDigits(r.psnr); }},
                    {"FLIP", [](const Row& r) { return threeDigits(r.flip); }},
                    {"bias z", [](const Row& r) { return threeDigits(r.biasZ); }},
                    {"fireflies", [](const Row& r) { return whole(r.fireflies); }},
                    {"1/(mse s)", [](const Row& r) { return threeDigits(r.efficiency); }},
                    {"speed-up", [](const Row& r) { return threeDigits(r.speedup); }},
                    {"gain", [](const Row& r) { return threeDigits(r.gain); }},
                    {"joules", [](const Row& r) { return threeDigits(r.joules); }},
                });
    return makeTable(columns, rows);
}

std::string until(const Series& series, const Figure& figure, double target) {
    if (!figure) return kUnknown;
    const bool measured = series.reached && *series.reached <= target;
    return (measured ? "" : "~") + threeDigits(figure);
}

Table seriesTable(const std::vector<const Series*>& rows) {
    std::vector<Column<Series>> columns = axisColumns(rows);
    append<Series>(columns, {
                                {"slope of mse",
                                 [](const Series& s) {
                                     return threeDigits(s.slope) +
                                            (s.slopeError ? " ± " + threeDigits(s.slopeError) : "");
                                 }},
                                {"at the end", [](const Series& s) { return threeDigits(s.tailSlope); }},
                                {"s to relmse 1e-2", [](const Series& s) { return until(s, s.secondsTo1e2, 1e-2); }},
                                {"1e-3", [](const Series& s) { return until(s, s.secondsTo1e3, 1e-3); }},
                                {"1e-4", [](const Series& s) { return until(s, s.secondsTo1e4, 1e-4); }},
                                {"equal time, s", [](const Series& s) { return threeDigits(s.equalTime); }},
                                {"relmse then", [](const Series& s) { return threeDigits(s.relmseAtEqualTime); }},
                                {"equal relmse", [](const Series& s) { return threeDigits(s.equalError); }},
                                {"seconds to it", [](const Series& s) { return threeDigits(s.secondsAtEqualError); }},
                                {"gain", [](const Series& s) { return threeDigits(s.gain); }},
                            });
    return makeTable(columns, rows);
}

Table skipTable(const std::vector<const SkipRow*>& rows) {
    std::vector<Column<SkipRow>> columns = axisColumns(rows);
    append<SkipRow>(
        columns,
        {
            {"kernel", [](const SkipRow& s) { return s.kernel; }},
            {"spp", [](const SkipRow& s) { return whole(s.spp); }},
            {"s, exact mask", [](const SkipRow& s) { return threeDigits(s.secondsExact); }},
            {"s, all features", [](const SkipRow& s) { return threeDigits(s.secondsAll); }},
            {"time saved", [](const SkipRow& s) { return percent(*s.saved); }},
            {"least to most", [](const SkipRow& s) { return percent(*s.savedMin) + " to " + percent(*s.savedMax); }},
            {"image",
             [](const SkipRow& s) {
                 if (*s.differingPixels == 0) return std::string("same, bit for bit");
                 return percent(*s.differingPixels, 3) + " of the pixels differ, by " +
                        threeDigits(s.largestDifference) + " at most";
             }},
        });
    return makeTable(columns, rows);
}

Table referenceTable(const std::vector<const ReferenceRow*>& rows) {
    return makeTable<ReferenceRow>(
        {
            {"scene", [](const ReferenceRow& r) { return r.scene; }},
            {"size", [](const ReferenceRow& r) { return std::to_string(r.width) + "×" + std::to_string(r.height); }},
            {"depth", [](const ReferenceRow& r) { return std::to_string(r.maxDepth); }},
            {"engine", [](const ReferenceRow& r) { return r.engine; }},
            {"spp", [](const ReferenceRow& r) { return whole(r.spp); }},
            {"seconds now",
             [](const ReferenceRow& r) { return threeDigits(r.seconds) + (r.cached ? ", part cached" : ""); }},
            {"standard error", [](const ReferenceRow& r) { return threeDigits(r.rmse); }},
            {"good enough", [](const ReferenceRow& r) { return std::string(r.sufficient ? "yes" : "no"); }},
            {"other engine",
             [](const ReferenceRow& r) {
                 return r.verifiedZ ? r.verifiedBy + ", z at most " + threeDigits(std::abs(*r.verifiedZ))
                                    : std::string(kUnknown);
             }},
        },
        rows);
}

// The published columns beside ours, by samples per pixel; empty where the scene has none.
std::vector<Block> publishedBlocks(const Suite& suite, const std::vector<const Row*>& rows, const std::string& scene) {
    std::vector<const Published*> columns;
    for (const Published& published : suite.published)
        if (published.scene == scene) columns.push_back(&published);
    if (columns.empty()) return {};
    std::map<double, std::map<std::string, const Row*>> ours; // by spp and engine
    std::set<std::string> engines;
    for (const Row* row : rows) {
        if (row->config.scene != scene || !row->spp) continue;
        ours[*row->spp].emplace(row->config.engine, row);
        engines.insert(row->config.engine);
    }
    Table table{{"spp"}, {}};
    for (const Published* published : columns) table.header.push_back(published->name + ", s");
    for (const std::string& engine : engines) {
        table.header.push_back("ours " + engine + ", s");
        for (const Published* published : columns) table.header.push_back(published->name + " / " + engine);
    }
    for (const auto& [spp, byEngine] : ours) {
        std::vector<std::string> cells{whole(spp)};
        const auto theirs = [spp = spp](const Published* published) {
            const auto found = published->seconds.find(static_cast<std::uint32_t>(spp));
            return found == published->seconds.end() ? Figure() : Figure(found->second);
        };
        for (const Published* published : columns) cells.push_back(threeDigits(theirs(published)));
        for (const std::string& engine : engines) {
            const auto found = byEngine.find(engine);
            const Figure seconds = found == byEngine.end() ? Figure() : found->second->seconds;
            cells.push_back(threeDigits(seconds));
            for (const Published* published : columns) {
                const Figure their = theirs(published);
                cells.push_back(threeDigits(their && seconds ? Figure(*their / *seconds) : std::nullopt));
            }
        }
        table.rows.push_back(cells);
    }
    return {Heading{3, "Beside what was published: " + scene}, table};
}

// What tells the configuration from its experiment's others.
std::string nameOf(const Series& series, const std::vector<const Series*>& others) {
    std::string name;
    for (const Axis& axis : axes()) {
        std::set<std::string> values;
        for (const Series* other : others) values.insert(axis.get(other->config));
        if (values.size() > 1 && axis.name != "scene" && axis.name != "height")
            name += (name.empty() ? "" : ", ") + axis.get(series.config);
    }
    return name;
}

// Of each experiment and scene the configuration that comes first to the error that all reach.
std::vector<Block> winners(const Suite& suite, const Results& results) {
    Table table{{"experiment", "scene", "least time to equal relmse", "relmse", "seconds", "gain over baseline"}, {}};
    for (const Experiment& experiment : suite.experiments) {
        std::vector<const Series*> own;
        for (const Series& series : results.series)
            if (series.experiment == experiment.name && series.secondsAtEqualError) own.push_back(&series);
        std::map<std::string, std::vector<const Series*>> byScene;
        for (const Series* series : own) byScene[series->config.scene].push_back(series);
        for (const auto& [scene, all] : byScene) {
            if (all.size() < 2) continue;
            const Series* best = *std::min_element(all.begin(), all.end(), [](const Series* a, const Series* b) {
                return *a->secondsAtEqualError < *b->secondsAtEqualError;
            });
            table.rows.push_back({experiment.name, scene, nameOf(*best, own), threeDigits(best->equalError),
                                  threeDigits(best->secondsAtEqualError), threeDigits(best->gain)});
        }
    }
    if (table.rows.empty()) return {};
    return {Heading{2, "In short"}, table};
}

// The defaults against the best configuration, experiment by experiment.
std::vector<Block> defaultsBlocks(const Results& results) {
    Table table{{"experiment", "engine", "scenes", "geometric mean", "least", "in", "where the best is"}, {}};
    for (const DefaultsRow& row : compareDefaults(results.rows)) {
        std::string best;
        for (const Axis& axis : axes()) {
            const std::string value = axis.get(row.leastBest);
            if (axis.name == "scene" || axis.name == "engine" || axis.name == "width" || axis.name == "height")
                continue;
            if (value != axis.get(Config())) best += (best.empty() ? "" : ", ") + value;
        }
        table.rows.push_back({row.experiment, row.engine, std::to_string(row.scenes),
                              withInterval(row.mean, row.meanCi), withInterval(row.least, row.leastCi), row.leastScene,
                              best.empty() ? "the default" : best});
    }
    if (table.rows.empty()) return {};
    return {Heading{2, "What the defaults reach of the best efficiency, 1 / (mse s)"}, table};
}

void appendExperiment(Document& document, const Experiment& experiment, const Results& results, const Suite& suite) {
    std::vector<const Row*> rows;
    for (const Row& row : results.rows)
        if (row.experiment == experiment.name) rows.push_back(&row);
    if (rows.empty()) return;
    std::vector<const Series*> series;
    for (const Series& one : results.series)
        if (one.experiment == experiment.name) series.push_back(&one);
    document.push_back(Heading{2, experiment.title});
    std::vector<std::string> scenes;
    for (const Row* row : rows)
        if (std::find(scenes.begin(), scenes.end(), row->config.scene) == scenes.end())
            scenes.push_back(row->config.scene);
    for (const std::string& scene : scenes)
        for (Block& block : publishedBlocks(suite, rows, scene)) document.push_back(std::move(block));
    for (Chart& chart : makeCharts(rows))
        if (!chart.lines.empty()) document.push_back(std::move(chart));
    if (!series.empty()) document.push_back(seriesTable(series));
    for (const PictureGrid& grid : results.grids)
        if (grid.experiment == experiment.name) document.push_back(grid);
    document.push_back(rowTable(rows));
}

void writeFile(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    file.stream() << text;
    file.commit();
}

} // namespace

std::string threeDigits(const Figure& figure) {
    if (!figure) return kUnknown;
    if (!std::isfinite(*figure)) return "∞";
    char text[32];
    const double size = std::abs(*figure);
    std::snprintf(text, sizeof text, size >= 1000 && size < 1e6 ? "%.0f" : "%.3g", *figure);
    return text;
}

Document makeReport(const Results& results, const Suite& suite) {
    Document document{Heading{1, results.title}};
    Table machine{{"", ""}, {}};
    for (const Fact& fact : results.facts) machine.rows.push_back({fact.name, fact.value});
    if (!results.complete) document.push_back(Paragraph{"Interrupted: this is what had been measured by then."});
    if (!machine.rows.empty()) document.push_back(machine);
    for (const std::string& notice : results.notices) document.push_back(Paragraph{notice});
    for (Block& block : winners(suite, results)) document.push_back(std::move(block));
    for (Block& block : defaultsBlocks(results)) document.push_back(std::move(block));
    for (const Experiment& experiment : suite.experiments) appendExperiment(document, experiment, results, suite);
    if (!results.skips.empty()) {
        std::vector<const SkipRow*> rows;
        for (const SkipRow& row : results.skips) rows.push_back(&row);
        document.push_back(Heading{2, "What the scene does not need, skipped"});
        document.push_back(skipTable(rows));
    }
    if (!results.references.empty()) {
        std::vector<const ReferenceRow*> rows;
        for (const ReferenceRow& row : results.references) rows.push_back(&row);
        document.push_back(Heading{2, "References"});
        document.push_back(
            Paragraph{"Rendered with another seed; their time counts nowhere. Their variance is subtracted from mse, "
                      "rmse and relmse."});
        document.push_back(referenceTable(rows));
    }
    return document;
}

void checkReportFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw RenderError(folder.string() + ": cannot be made: " + error.message());
    AtomicFile probe(folder / "results.json"); // removed again, as it is not committed
}

void writeReport(const std::filesystem::path& folder, const Results& results, const Suite& suite) {
    checkReportFolder(folder);
    const Document document = makeReport(results, suite);
    writeFile(folder / "results.json", toJson(results));
    writeFile(folder / "results.csv", toCsv(results));
    const auto plotName = [](std::size_t i) { return "plot-" + std::to_string(i + 1) + ".svg"; };
    const std::vector<std::string> svgs = svgsOf(document);
    for (std::size_t i = 0; i < svgs.size(); ++i) writeFile(folder / plotName(i), svgs[i]);
    writeFile(folder / "report.md", toMarkdown(document, plotName));
    writeFile(folder / "report.html", toHtml(document, results.title));
}

} // namespace rt::bench
