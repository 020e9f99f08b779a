#include <algorithm>
#include <map>
#include <variant>

#include "Common/Bench/Markup.h"
#include "Common/Bench/Overloaded.h"
#include "Common/Bench/Pictures.h"
#include "Common/Bench/ReportParts.h"

namespace rt::bench {
namespace {

// Colours are named once; those of charts are given with each line, and are changed on dark paper alone.
constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#222;--paper:#fff;--line:#ddd;--head:#f4f4f4;--mark:#fff0b8;--link:#0b57a4}
@media screen and (prefers-color-scheme:dark){
:root{--ink:#e2e4e8;--paper:#17191d;--line:#3a3e45;--head:#23262c;--mark:#5a4a10;--link:#8ab8f0}
svg [fill="#fff"]{fill:var(--paper)}svg text{fill:var(--ink)}svg [stroke="#ddd"]{stroke:#3a3e45}
svg [stroke="#f2f2f2"]{stroke:#22252a}svg [stroke="#0072b2"]{stroke:#3d9bd6}svg [fill="#0072b2"]{fill:#3d9bd6}
svg [stroke="#444444"]{stroke:#c0c4ca}svg [fill="#444444"]{fill:#c0c4ca}}
body{font:15px/1.45 sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:var(--ink);background:var(--paper)}
h1,h2,h3{line-height:1.2}h2{margin-top:2em;border-bottom:1px solid var(--line)}a{color:var(--link)}
.wide{overflow-x:auto}table{border-collapse:collapse;margin:.6em 0;font-size:13px}
th,td{padding:.2em .6em;border:1px solid var(--line);text-align:left;white-space:nowrap}th{background:var(--head)}
.n{text-align:right}tr:target td,tr.shown td{background:var(--mark)}tr[id]{scroll-margin-top:3em}
th button{font:inherit;color:inherit;background:none;border:0;padding:0;cursor:pointer}
th button::after{content:" \2195";opacity:.45}th[aria-sort=ascending] button::after{content:" \2191";opacity:1}
th[aria-sort=descending] button::after{content:" \2193";opacity:1}
.charts{display:inline-block;margin:.4em .6em .4em 0;vertical-align:top;max-width:100%}svg{max-width:100%;height:auto}
svg a:focus circle,svg a:hover circle,svg circle.shown{stroke:var(--ink);stroke-width:2}
.grid{display:flex;flex-wrap:wrap;gap:8px}figure{margin:0;width:180px}img{width:180px}figcaption{font-size:12px}
@media print{body{font-size:10pt;margin:0;max-width:none}.wide{overflow:visible}table{font-size:7pt}
th,td{white-space:normal;padding:.1em .3em}th button::after,th[aria-sort] button::after{content:""}
.charts,figure,tr{break-inside:avoid}h2,h3{break-after:avoid}}
)";

// Without it all is there but the sorting, and the row that a point leads to is shown as the target of its link alone.
constexpr const char* kScript = R"(
for (const table of document.querySelectorAll('table')) {
    if (!table.tHead || table.tBodies[0].rows.length < 2) continue;
    const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
    const value = (row, column) => {
        const text = row.cells[column].textContent.trim();
        if (!heads[column].classList.contains('n')) return text;
        if (text.startsWith('\u221e')) return Infinity;
        return parseFloat(text.replace(/^[~<]/, ''));
    };
    heads.forEach((head, column) => {
        const button = document.createElement('button');
        button.type = 'button';
        button.textContent = head.textContent;
        head.replaceChildren(button);
        button.addEventListener('click', () => {
            const sign = head.getAttribute('aria-sort') === 'ascending' ? -1 : 1;
            heads.forEach(other => other.removeAttribute('aria-sort'));
            head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
            const unknown = v => typeof v === 'number' && isNaN(v);
            const order = (a, b) => {
                const x = value(a, column), y = value(b, column);
                if (unknown(x) || unknown(y)) return unknown(x) - unknown(y);
                return sign * (typeof x === 'number' ? (x === y ? 0 : x - y) : x.localeCompare(y));
            };
            body.append(...[...body.rows].sort(order));
        });
    });
}
for (const link of document.querySelectorAll('svg a')) {
    const row = document.getElementById(link.getAttribute('href').slice(1));
    const show = on => row.classList.toggle('shown', on);
    const mark = on => link.lastElementChild.classList.toggle('shown', on);
    link.addEventListener('mouseenter', () => show(true));
    link.addEventListener('mouseleave', () => show(false));
    row.addEventListener('mouseenter', () => mark(true));
    row.addEventListener('mouseleave', () => mark(false));
}
)";

using Anchors = std::map<Origin, std::string>; // ids of the rows of tables

Anchors anchorsOf(const Document& document) {
    Anchors anchors;
    for (const Block& block : document)
        if (const Table* table = std::get_if<Table>(&block))
            for (const Origin origin : table->origins)
                anchors.emplace(origin, "row-" + std::to_string(anchors.size() + 1));
    return anchors;
}

std::string htmlTable(const Table& table, const Anchors& anchors) {
    const std::vector<bool> numbers = numberColumns(table);
    std::string text = "<div class=\"wide\"><table>\n";
    const auto line = [&](const std::vector<std::string>& cells, const std::string& tag, const std::string& id) {
        text += id.empty() ? "<tr>" : "<tr id=\"" + id + "\">";
        for (std::size_t c = 0; c < cells.size(); ++c)
            text += "<" + tag + (tag == "th" ? " scope=\"col\"" : "") + (numbers[c] ? " class=\"n\">" : ">") +
                    escapeMarkup(cells[c]) + "</" + tag + ">";
        text += "</tr>\n";
    };
    const auto isEmpty = [](const std::string& cell) { return cell.empty(); };
    if (!std::all_of(table.header.begin(), table.header.end(), isEmpty)) {
        text += "<thead>";
        line(table.header, "th", "");
        text += "</thead>";
    }
    text += "<tbody>\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        line(table.rows[i], "td", table.origins.empty() ? "" : anchors.at(table.origins[i]));
    return text + "</tbody></table></div>\n";
}

std::string htmlGrid(const PictureGrid& grid) {
    std::string text = "<div class=\"grid\">\n";
    for (const Picture& picture : grid.pictures)
        text += "<figure><img src=\"" + dataUri(picture.image) + "\" alt=\"" + escapeMarkup(picture.caption) +
                "\"><figcaption>" + escapeMarkup(picture.caption) + "</figcaption></figure>\n";
    return text + "</div>\n";
}

} // namespace

std::string toHtml(const Document& document, const std::string& title) {
    const Anchors anchors = anchorsOf(document);
    const auto linkOf = [&](Origin origin) {
        const auto found = anchors.find(origin);
        return found == anchors.end() ? std::string() : "#" + found->second;
    };
    std::string text =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
        escapeMarkup(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
    const auto write = Overloaded{
        [&](const Heading& h) {
            const std::string tag = "h" + std::to_string(h.level);
            text += "<" + tag + ">" + escapeMarkup(h.text) + "</" + tag + ">\n";
        },
        [&](const Paragraph& p) { text += "<p>" + escapeMarkup(p.text) + "</p>\n"; },
        [&](const Table& t) { text += htmlTable(t, anchors); },
        [&](const Chart& c) { text += "<div class=\"charts\">" + toSvg(c, linkOf) + "</div>\n"; },
        [&](const PictureGrid& g) { text += htmlGrid(g); },
    };
    for (const Block& block : document) std::visit(write, block);
    return text + "<script>" + kScript + "</script>\n</body>\n</html>\n";
}

} // namespace rt::bench
