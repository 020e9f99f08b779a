#include <algorithm>
#include <cctype>
#include <vector>

#include "Common/Manual/Formats.h"

namespace rt::manual {
namespace {

// Text that roff takes for text.
std::string roffText(const std::string& text) {
    std::string out;
    if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string roffBold(const std::string& text) {
    return "\\fB" + roffText(text) + "\\fR";
}

std::string upperCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

// An argument of a macro.
std::string roffQuoted(const std::string& text) {
    return "\"" + text + "\"";
}

void appendManTerm(std::string& out, const std::string& term, const std::string& text) {
    out += ".TP\n" + term + "\n" + roffText(text) + "\n";
}

void appendManTerms(std::string& out, const char* title, const std::vector<Term>& terms) {
    if (terms.empty()) return;
    out += std::string(".SH ") + roffQuoted(title) + "\n";
    for (const Term& term : terms) appendManTerm(out, roffBold(term.name), term.help);
}

void appendManFlag(std::string& out, const Flag& flag) {
    std::string term;
    for (const std::string& name : flag.names) term += (term.empty() ? "" : ", ") + roffBold(name);
    if (!flag.value.empty()) term += " \\fI" + roffText(shownValue(flag)) + "\\fR";
    std::string text = flag.help.empty() ? "An argument." : flag.help;
    if (!flag.byDefault.empty()) text += " (default: " + flag.byDefault + ")";
    appendManTerm(out, term, text);
    if (flag.choices.empty()) return;
    out += ".RS\n";
    for (const Term& choice : flag.choices) appendManTerm(out, roffBold(choice.name), choice.help);
    out += ".RE\n";
}

// Arguments and flags of a program or of a command.
void appendManFlags(std::string& out, const Page& page) {
    for (const Flag& argument : page.arguments) appendManFlag(out, argument);
    const std::vector<std::string> groups = groupsOf(page);
    for (const std::string& group : groups) {
        if (groups.size() > 1) out += ".SS " + roffQuoted(roffText(group)) + "\n";
        for (const Flag& flag : page.flags)
            if (flag.group == group) appendManFlag(out, flag);
    }
}

void appendManExamples(std::string& out, const std::vector<Term>& examples) {
    if (examples.empty()) return;
    out += ".SH EXAMPLES\n";
    for (const Term& example : examples) appendManTerm(out, roffBold(example.name), example.help);
}

} // namespace

std::string manPage(const Page& page, const std::string& version) {
    std::string out = ".TH " + roffQuoted(roffText(upperCase(page.name))) + " 1 \"\" " +
                      roffQuoted("Ray Tracing Twins " + version) + " \"User Commands\"\n";
    const std::string firstSentence = page.summary.substr(0, page.summary.find(". "));
    out += ".SH NAME\n" + roffText(page.name) + " \\- " + roffText(firstSentence) + "\n";
    out += ".SH SYNOPSIS\n" + roffBold(page.name) + roffText(usageOf(page).substr(page.name.size())) + "\n";
    out += ".SH DESCRIPTION\n" + roffText(page.summary) + "\n.SH OPTIONS\n";
    appendManFlags(out, page);
    for (const Page& command : page.commands) {
        out += ".SH " + roffQuoted(roffText(upperCase(command.name.substr(page.name.size() + 1)))) + "\n";
        out += roffBold(command.name) + roffText(usageOf(command).substr(command.name.size())) + "\n.PP\n" +
               roffText(command.summary) + ".\n";
        appendManFlags(out, command);
    }
    appendManTerms(out, "EXIT STATUS", exitCodes());
    appendManTerms(out, "ENVIRONMENT", page.environment);
    appendManExamples(out, page.examples);
    out += ".SH SEE ALSO\n";
    std::string others;
    for (const char* name : {"ray-tracing-bench", "ray-tracing-cpu", "ray-tracing-gpu", "ray-tracing-image"})
        if (page.name != name) others += (others.empty() ? "" : ", ") + roffBold(name) + "(1)";
    return out + others + "\n";
}

} // namespace rt::manual
