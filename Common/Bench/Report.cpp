#include "Common/Bench/Report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "Common/Bench/Cells.h"
#include "Common/Bench/ReportParts.h"
#include "Common/Bench/ResultsJson.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"

namespace rt::bench {
namespace {

constexpr double kBusy = 0.9; // below which a reader should know of it

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

template <class T>
void append(std::vector<Column<T>>& to, std::vector<Column<T>> more) {
    for (Column<T>& column : more) to.push_back(std::move(column));
}

Table rowTable(const std::vector<const Row*>& rows) {
    std::vector<Column<Row>> columns = axisColumns(rows);
    for (Column<Row>& column : columns) // 0 stands for all, however many that are
        if (column.header == "threads") column.cell = [](const Row& r) { return whole(r.threadsUsed); };
    // Two errors only where they are two.
    const bool bright = std::any_of(rows.begin(), rows.end(), [](const Row* row) { return row->shareUpTo1 < 1.0; });
    const auto upTo1 = [bright](const std::string& text) { return bright ? text : kUnknown; };
    const bool idle = std::any_of(rows.begin(), rows.end(), [](const Row* r) { return r->busy.value_or(1) < kBusy; });
    append<Row>(columns,
                {
                    {"spp", [](const Row& r) { return whole(r.spp); }},
                    {"seconds", seconds},
                    {"denoising, s", [](const Row& r) { return threeDigits(r.secondsDenoise); }},
                    {"threads busy", [=](const Row& r) { return idle && r.busy ? percent(*r.busy, 0) : kUnknown; }},
                    {"M samples/s", [](const Row& r) { return threeDigits(times(r.samplesPerSecond, 1e-6)); }},
                    {"M rays/s", [](const Row& r) { return threeDigits(times(r.raysPerSecond, 1e-6)); }},
                    {"of ceiling", [](const Row& r) { return r.ceiling ? percent(*r.ceiling, 0) : kUnknown; }},
                    {"mse", [](const Row& r) { return withInterval(r.mse, r.mseCi); }},
                    {"mse up to 1", [=](const Row& r) { return upTo1(withInterval(r.mseUpTo1, r.mseUpTo1Ci)); }},
                    {"relmse", [](const Row& r) { return withInterval(r.relmse, r.relmseCi); }},
                    {"estimated", [](const Row& r) { return threeDigits(r.estimatedRelmse); }},
                    {"psnr", [](const Row& r) { return threeDigits(r.psnr); }},
                    {"FLIP", [](const Row& r) { return threeDigits(r.flip); }},
                    {"bias z", [](const Row& r) { return threeDigits(r.biasZ); }},
                    {"fireflies", [](const Row& r) { return whole(r.fireflies); }},
                    {"1/(mse s)", [](const Row& r) { return threeDigits(r.efficiency); }},
                    {"1/(mse s) up to 1", [=](const Row& r) { return upTo1(threeDigits(r.efficiencyUpTo1)); }},
                    {"speed-up", [](const Row& r) { return threeDigits(r.speedup); }},
                    {"gain", [](const Row& r) { return threeDigits(r.gain); }},
                    {"J, processor", [](const Row& r) { return threeDigits(r.joules); }},
                    {"J, GPU", [](const Row& r) { return threeDigits(r.joulesGpu); }},
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
                                {"s to relMSE 1e-2", [](const Series& s) { return until(s, s.secondsTo1e2, 1e-2); }},
                                {"1e-3", [](const Series& s) { return until(s, s.secondsTo1e3, 1e-3); }},
                                {"1e-4", [](const Series& s) { return until(s, s.secondsTo1e4, 1e-4); }},
                                {"equal time, s", [](const Series& s) { return threeDigits(s.equalTime); }},
                                {"relMSE then", [](const Series& s) { return threeDigits(s.relmseAtEqualTime); }},
                                {"equal relMSE", [](const Series& s) { return threeDigits(s.equalError); }},
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

bool isOf(const Published& published, const Row& row) {
    return published.scene == row.config.scene && published.width == row.config.settings.width &&
           published.height == row.config.settings.height;
}

// The published columns beside ours, by samples per pixel; empty where there is none for this scene in this size.
std::vector<Block> publishedBlocks(const Suite& suite, const std::vector<const Row*>& rows, const std::string& scene) {
    std::vector<const Published*> columns;
    for (const Published& published : suite.published)
        if (published.scene == scene &&
            std::any_of(rows.begin(), rows.end(), [&](const Row* row) { return isOf(published, *row); }))
            columns.push_back(&published);
    if (columns.empty()) return {};
    std::map<double, std::map<std::string, const Row*>> ours; // by spp and engine
    std::set<std::string> engines;
    for (const Row* row : rows) {
        if (!row->spp || !isOf(*columns.front(), *row)) continue;
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
    return {Heading{3, "Beside what was published: " + scene + ", " + std::to_string(columns.front()->width) + "×" +
                           std::to_string(columns.front()->height)},
            table};
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
    for (Block& block : efficiencyBlocks(rows)) document.push_back(std::move(block));
    for (Chart& chart : makeCharts(rows))
        if (!chart.lines.empty()) document.push_back(std::move(chart));
    if (!series.empty()) document.push_back(seriesTable(series));
    for (const PictureGrid& grid : results.grids)
        if (grid.experiment == experiment.name) document.push_back(grid);
    document.push_back(rowTable(rows));
}

const Table& columnMeanings() {
    static const Table table{
        {"column", "what it says"},
        {
            {"seconds",
             "wall time of sampling and, where pictures are denoised, of the filter and its features: median of the "
             "repeats, ± half of the distance from least to most"},
            {"threads busy",
             "processor seconds of this program over seconds × threads: the rest went to other programs, or "
             "there was too little work for so many"},
            {"of ceiling",
             "rays/s, shading included, over what the hardware does with rays alone; shadow rays are cheaper, so "
             "that it can exceed 100 %"},
            {"mse",
             "mean((x − ref)²) over pixels and channels, ± half of a 95 % confidence interval over the repeats or, "
             "with "
             "less than three, over tiles of the image"},
            {"up to 1",
             "of the pixels alone that the reference has at 1 or less in every channel: without visible lights"},
            {"one for each setting",
             "efficiency over that of the row's best setting, whose variance × time stands before; ± by "
             "the interval of its own mse; error ~ 0: it cannot be told from zero"},
            {"relmse", "mean((x − ref)² / (ref² + 0.01))"},
            {"psnr, FLIP", "of what a screen shows: decibels; 0 (the same) to 1"},
            {"bias z",
             "image and reference have the same mean: standard deviations, of the worst channel and repeat; beyond ±4 "
             "one of the two is wrong, or a few bright samples rule the picture"},
            {"fireflies", "pixels brighter than the reference by more than ten times the rmse"},
            {"speed-up, gain",
             "ratio to the baseline of samples/s; of 1 / (mse s) or, where curves are compared, of the seconds "
             "to equal relMSE"},
            {"slope of mse",
             "of log mse over log samples, −1 for independent samples; at the end: of the last two steps"},
            {"s to relMSE", "interpolated between steps; ~: extrapolated with slope −1"},
        }};
    return table;
}

void writeFile(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    file.stream() << text;
    file.commit();
}

} // namespace

Document makeReport(const Results& results, const Suite& suite) {
    Document document{Heading{1, results.title}};
    if (!results.complete) document.push_back(Paragraph{"Interrupted: this is what had been measured by then."});
    for (Block& block : summaryBlocks(suite, results)) document.push_back(std::move(block));
    for (Block& block : denoiseBlocks(results.rows)) document.push_back(std::move(block));
    Table machine{{"", ""}, {}};
    for (const Fact& fact : results.facts) machine.rows.push_back({fact.name, fact.value});
    if (!machine.rows.empty()) {
        document.push_back(Heading{2, "Where it was measured"});
        document.push_back(machine);
    }
    if (!results.notices.empty()) document.push_back(Heading{2, "What is to be known"});
    for (const std::string& notice : results.notices) document.push_back(Paragraph{notice});
    for (Block& block : defaultsBlocks(results.rows)) document.push_back(std::move(block));
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
                      "RMSE and relMSE."});
        document.push_back(referenceTable(rows));
    }
    if (!results.rows.empty()) {
        document.push_back(Heading{2, "How to read the tables"});
        document.push_back(columnMeanings());
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
