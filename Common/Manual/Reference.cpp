#include <vector>

#include "Common/Manual/Formats.h"

namespace rt::manual {
namespace {

// Text of a cell of a table.
std::string cell(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '|' || c == '<' || c == '*' || c == '_') out += '\\';
        out += c;
    }
    return out;
}

// Flags and values are no names of this tree, which backquotes are for.
std::string code(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '|')
            out += "&#124;";
        else if (c == '<')
            out += "&lt;";
        else
            out += c;
    }
    return "<code>" + out + "</code>";
}

void appendRow(std::string& out, const Flag& flag) {
    std::string names;
    for (const std::string& name : flag.names) names += (names.empty() ? "" : ", ") + code(name);
    if (!flag.value.empty()) names += " " + code(shownValue(flag));
    std::string text = cell(flag.help);
    for (const Term& choice : flag.choices) text += "<br>" + code(choice.name) + ": " + cell(choice.help);
    out += "| " + names + " | " + (flag.byDefault.empty() ? "" : code(flag.byDefault)) + " | " + text + " |\n";
}

constexpr const char* kTableHead = "| flag | default | what it does |\n|---|---|---|\n";

void appendReferenceFlags(std::string& out, const Page& page, const std::string& level) {
    if (!page.arguments.empty()) {
        out += "\n| argument | default | what it is |\n|---|---|---|\n";
        for (const Flag& argument : page.arguments) appendRow(out, argument);
    }
    const std::vector<std::string> groups = groupsOf(page);
    for (const std::string& group : groups) {
        out += groups.size() > 1 ? "\n" + level + " " + group + "\n\n" : "\n";
        out += kTableHead;
        for (const Flag& flag : page.flags)
            if (flag.group == group) appendRow(out, flag);
    }
}

} // namespace

std::string referenceChapter(const Page& page) {
    std::string out = "\n## " + page.name + "\n\n" + page.summary + "\n\n    " + usageOf(page) + "\n";
    appendReferenceFlags(out, page, "###");
    for (const Page& command : page.commands) {
        out += "\n### " + command.name + "\n\n" + command.summary + ".\n\n    " + usageOf(command) + "\n";
        appendReferenceFlags(out, command, "####");
    }
    if (!page.environment.empty()) out += "\n### Environment\n\n";
    for (const Term& variable : page.environment) out += "- " + code(variable.name) + ": " + cell(variable.help) + "\n";
    if (!page.examples.empty()) out += "\n### Examples\n";
    for (const Term& example : page.examples) out += "\n" + example.help + ":\n\n    " + example.name + "\n";
    return out;
}

} // namespace rt::manual
