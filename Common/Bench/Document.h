// A report as headings, paragraphs, tables, charts and pictures, written as Markdown or, by ReportPage.h, as HTML.
#pragma once
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "Common/Bench/Chart.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

struct Heading {
    int level = 2; // 1 to 4
    std::string text;
};
struct Paragraph {
    std::string text;
};
struct Table {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows; // each as long as the header
    std::vector<Origin> origins = {};           // of the rows, or empty; of one table alone in a document
};
using Block = std::variant<Heading, Paragraph, Table, Chart, PictureGrid>;
using Document = std::vector<Block>;

// `linkOf` gives the file of the chart with this number, counted from 0, or "" where charts are not shown. Pictures are
// not.
std::string toMarkdown(const Document& document, const std::function<std::string(std::size_t)>& linkOf);

// Columns of numbers, with units and intervals or unknown, which go to the right.
std::vector<bool> numberColumns(const Table& table);

// In the order of the document; empty ones included.
std::vector<std::string> svgsOf(const Document& document);

} // namespace rt::bench
