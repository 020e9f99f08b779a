#include "Common/Manual/Help.h"

#include <cstddef>
#include <sstream>
#include <vector>

#include "Common/Manual/Text.h"

namespace rt::manual {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kTextColumn = 27; // where explanations begin

// Appends `text` in lines of at most kColumns, the first from where `out` stands, the others from `column` on.
void appendWrapped(std::string& out, std::size_t at, std::size_t column, const std::string& text) {
    std::istringstream words(text);
    bool isFirst = true;
    for (std::string word; words >> word; isFirst = false) {
        if (!isFirst && at + 1 + word.size() > kColumns) {
            out += "\n" + std::string(column, ' ');
            at = column;
        } else if (!isFirst) {
            out += ' ';
            ++at;
        }
        out += word;
        at += word.size();
    }
    out += '\n';
}

// A name at `indent` and its explanation in the column of explanations, below the name where that is long.
void appendEntry(std::string& out, std::size_t indent, const std::string& name, const std::string& text) {
    out += std::string(indent, ' ') + name;
    const std::size_t end = indent + name.size();
    if (end + 2 > kTextColumn)
        out += "\n" + std::string(kTextColumn, ' ');
    else
        out += std::string(kTextColumn - end, ' ');
    appendWrapped(out, kTextColumn, kTextColumn, text);
}

std::string nameAndValue(const Flag& flag) {
    return spellingsOf(flag) + (flag.value.empty() ? "" : " " + shownValue(flag));
}

// `help`: all of it or what stands before the details.
std::string helpAndDefault(const Flag& flag, const std::string& help) {
    return help + (flag.byDefault.empty() ? "" : " (" + flag.byDefault + ")");
}

void appendFlag(std::string& out, const Flag& flag, bool withDetails) {
    appendEntry(out, 2, nameAndValue(flag), helpAndDefault(flag, withDetails ? flag.help : firstPart(flag.help)));
    if (!withDetails) return;
    for (const Term& choice : flag.choices) appendEntry(out, 6, choice.name, choice.help);
}

void appendHead(std::string& out, const Page& page) {
    appendWrapped(out, 0, 0, page.summary);
    out += "\n  " + usageOf(page) + "\n\n";
}

// What stands beside flags; without a word to say, an argument's name says it all.
void appendArgumentsAndCommands(std::string& out, const Page& page) {
    for (const Flag& argument : page.arguments)
        if (!argument.help.empty())
            appendEntry(out, 2, argument.names.front(), helpAndDefault(argument, argument.help));
    for (const Page& command : page.commands)
        appendEntry(out, 2, command.name.substr(page.name.size() + 1), command.summary);
}

void appendFlags(std::string& out, const Page& page) {
    const std::vector<std::string> groups = groupsOf(page);
    for (const std::string& group : groups) {
        if (groups.size() > 1) out += (out.ends_with("\n\n") ? "" : "\n") + group + ":\n";
        for (const Flag& flag : page.flags)
            if (flag.group == group) appendFlag(out, flag, true);
    }
}

} // namespace

std::string helpText(const Page& page) {
    std::string out;
    appendHead(out, page);
    appendArgumentsAndCommands(out, page);
    if (page.essentials.empty()) {
        appendFlags(out, page);
        return out;
    }
    for (const std::string& name : page.essentials)
        if (const Flag* flag = findFlag(page, name)) appendFlag(out, *flag, false);
    appendEntry(out, 2, "--help-all", "every flag, and what its values do");
    return out;
}

std::string fullHelpText(const Page& page) {
    std::string out;
    appendHead(out, page);
    appendArgumentsAndCommands(out, page);
    appendFlags(out, page);
    for (const Page& command : page.commands) out += "\n" + fullHelpText(command);
    if (!page.examples.empty()) out += "\nExamples:\n";
    for (const Term& example : page.examples) {
        out += "  " + example.name + "\n" + std::string(6, ' ');
        appendWrapped(out, 6, 6, example.help);
    }
    return out;
}

} // namespace rt::manual
