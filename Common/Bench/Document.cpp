#include "Common/Bench/Document.h"

#include <algorithm>
#include <cstddef>

#include "Common/Bench/Overloaded.h"

namespace rt::bench {
namespace {

std::string escapeCell(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
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

} // namespace

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

std::vector<std::string> svgsOf(const Document& document) {
    std::vector<std::string> all;
    for (const Block& block : document)
        if (const Chart* chart = std::get_if<Chart>(&block)) all.push_back(toSvg(*chart));
    return all;
}

} // namespace rt::bench
