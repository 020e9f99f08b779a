// How figures and axes become the cells of tables.
#pragma once
#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

inline constexpr const char* kUnknown = "–";

std::string percent(double value, int digits = 1);
std::string whole(const Figure& figure);                           // rounded
std::string threeDigits(const Figure& figure);                     // significant ones
std::string withInterval(const Figure& value, const Figure& half); // "0.123 ±4 %"

std::string sceneName(const std::string& scene); // of a file without its folders

// What tells a configuration from the others, by the axes that count.
std::string nameOf(const Config& config, const std::vector<const Config*>& others,
                   const std::function<bool(const Axis&)>& counts);

// ---- columns that show something -----------------------------------------------------------------------------------

template <class T>
struct Column {
    std::string header;
    std::function<std::string(const T&)> cell;
};

template <class T>
Table makeTable(const std::vector<Column<T>>& columns, const std::vector<const T*>& rows) {
    Table table;
    table.rows.resize(rows.size());
    table.origins.assign(rows.begin(), rows.end());
    for (const Column<T>& column : columns) {
        std::vector<std::string> cells;
        cells.reserve(rows.size());
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
            columns.push_back({std::string(axis.name), [&axis](const T& row) {
                                   return isKnown(axis, row.config) ? axis.get(row.config) : kUnknown;
                               }});
    }
    return columns;
}

} // namespace rt::bench
