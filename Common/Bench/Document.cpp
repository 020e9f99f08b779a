#include "Common/Bench/Document.h"

#include <algorithm>

#include "Common/Bench/Markup.h"
#include "Common/Bench/Pictures.h"

namespace rt::bench {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

std::string escapeCell(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
}

// Columns of numbers, with units and intervals or unknown, which go to the right.
std::vector<bool> numberColumns(const Table& table) {
    const auto isNumber = [](const std::string& cell) {
        return cell == "–" || (cell.find_first_of("0123456789∞") != std::string::npos &&
                               cell.find_first_not_of("0123456789.-+e%~<±∞x ") == std::string::npos);
    };
    std::vector<bool> numbers(table.header.size(), true);
    for (std::size_t c = 0; c < numbers.size(); ++c)
        for (const auto& row : table.rows) numbers[c] = numbers[c] && isNumber(row[c]);
    return numbers;
}

// Columns padded, so that it reads well as plain text too.
std::string markdownTable(Table table) {
    for (auto& row : table.rows)
        for (std::string& cell : row) cell = escapeCell(cell);
    std::vector<std::size_t> widths(table.header.size(), 3);
    const std::vector<bool> right = numberColumns(table);
    const auto lengthOf = [](const std::string& text) { // of UTF-8
        return static_cast<std::size_t>(
            std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
    };
    for (std::size_t c = 0; c < table.header.size(); ++c) {
        widths[c] = std::max(widths[c], lengthOf(table.header[c]));
        for (const auto& row : table.rows) widths[c] = std::max(widths[c], lengthOf(row[c]));
    }
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string text = "|";
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::string padding(widths[c] - lengthOf(cells[c]), ' ');
            text += " " + (right[c] ? padding + cells[c] : cells[c] + padding) + " |";
        }
        return text + "\n";
    };
    std::string text = line(table.header) + "|";
    for (std::size_t c = 0; c < table.header.size(); ++c)
        text += std::string(right[c] ? widths[c] + 1 : widths[c] + 2, '-') + (right[c] ? ":|" : "|");
    text += "\n";
    for (const auto& row : table.rows) text += line(row);
    return text;
}

std::string htmlTable(const Table& table) {
    const std::vector<bool> numbers = numberColumns(table);
    std::string text = "<div class=\"wide\"><table>\n";
    const auto line = [&](const std::vector<std::string>& cells, const std::string& tag) {
        text += "<tr>";
        for (std::size_t c = 0; c < cells.size(); ++c)
            text += "<" + tag + (numbers[c] ? " class=\"n\">" : ">") + escapeMarkup(cells[c]) + "</" + tag + ">";
        text += "</tr>\n";
    };
    const auto isEmpty = [](const std::string& cell) { return cell.empty(); };
    if (!std::all_of(table.header.begin(), table.header.end(), isEmpty)) line(table.header, "th");
    for (const auto& row : table.rows) line(row, "td");
    return text + "</table></div>\n";
}

std::string htmlGrid(const PictureGrid& grid) {
    std::string text = "<div class=\"grid\">\n";
    for (const Picture& picture : grid.pictures)
        text += "<figure><img src=\"" + dataUri(picture.image) + "\" alt=\"" + escapeMarkup(picture.caption) +
                "\"><figcaption>" + escapeMarkup(picture.caption) + "</figcaption></figure>\n";
    return text + "</div>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:1150px;padding:0 1em;color:#222;background:#fff}"
    "h1,h2,h3{line-height:1.2}h2{margin-top:2em;border-bottom:1px solid #ccc}"
    ".wide{overflow-x:auto}table{border-collapse:collapse;margin:.6em 0;font-size:13px}"
    "th,td{padding:.2em .6em;border:1px solid #ddd;text-align:left;white-space:nowrap}th{background:#f4f4f4}"
    ".n{text-align:right}"
    ".charts{display:inline-block;margin:.4em .6em .4em 0;vertical-align:top}"
    ".grid{display:flex;flex-wrap:wrap;gap:8px}figure{margin:0;width:180px}img{width:180px;image-rendering:auto}"
    "figcaption{font-size:12px}";

} // namespace

std::string toMarkdown(const Document& document, const std::function<std::string(std::size_t)>& linkOf) {
    std::string text;
    std::size_t charts = 0;
    const auto write = Overloaded{
        [&](const Heading& h) { text += std::string(static_cast<std::size_t>(h.level), '#') + " " + h.text + "\n\n"; },
        [&](const Paragraph& p) { text += p.text + "\n\n"; },
        [&](const Table& t) { text += markdownTable(t) + "\n"; },
        [&](const Chart& c) {
            if (const std::string link = linkOf(charts++); !link.empty())
                text += "![" + c.title + "](" + link + ")\n\n";
        },
        [](const PictureGrid&) {},
    };
    for (const Block& block : document) std::visit(write, block);
    return text;
}

std::string toHtml(const Document& document, const std::string& title) {
    std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
                       escapeMarkup(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
    const auto write = Overloaded{
        [&](const Heading& h) {
            const std::string tag = "h" + std::to_string(h.level);
            text += "<" + tag + ">" + escapeMarkup(h.text) + "</" + tag + ">\n";
        },
        [&](const Paragraph& p) { text += "<p>" + escapeMarkup(p.text) + "</p>\n"; },
        [&](const Table& t) { text += htmlTable(t); },
        [&](const Chart& c) { text += "<div class=\"charts\">" + toSvg(c) + "</div>\n"; },
        [&](const PictureGrid& g) { text += htmlGrid(g); },
    };
    for (const Block& block : document) std::visit(write, block);
    return text + "</body>\n</html>\n";
}

std::vector<std::string> svgsOf(const Document& document) {
    std::vector<std::string> all;
    for (const Block& block : document)
        if (const Chart* chart = std::get_if<Chart>(&block)) all.push_back(toSvg(*chart));
    return all;
}

} // namespace rt::bench
