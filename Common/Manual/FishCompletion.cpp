#include <string>

#include "Common/Manual/Formats.h"
#include "Common/Manual/Text.h"
#include "Common/Manual/Values.h"

namespace rt::manual {
namespace {

std::string fishQuoted(const std::string& text) {
    return "'" + withBackslashes(text, "'\\") + "'";
}

// A command that prints words with commas: what is typed, up to its last comma, with each word.
std::string fishList(const ValueForm& form) {
    return "(set -l typed (commandline -ct | string replace -r \"[^,]*\\$\" \"\"); "
           "for word in " +
           joined(form.words, " ") + "; echo $typed$word; end)";
}

std::string fishFiles(const ValueForm& form) {
    std::string commands;
    for (const std::string& ending : form.endings)
        commands += (commands.empty() ? "" : "; ") + std::string("__fish_complete_suffix ") + ending;
    // Each command lists all files, those of its ending first.
    std::string pattern;
    for (const std::string& ending : form.endings) pattern += (pattern.empty() ? "" : "|") + ending.substr(1);
    return "(begin; " + commands + "; end | string match -r \".*(?:/|\\.(?:" + pattern + "))\\$\" | sort -u)";
}

std::string fishValue(const Flag& flag, const SceneIds& scenes) {
    const ValueForm form = formOf(flag.value);
    switch (form.kind) {
        case ValueForm::Kind::Words:
            return " -x -a " + fishQuoted(form.isList ? fishList(form) : joined(form.words, " "));
        case ValueForm::Kind::File:
            return form.endings.empty() ? " -r -F" : " -x -a " + fishQuoted(fishFiles(form));
        case ValueForm::Kind::Folder:
            return " -x -a '(__fish_complete_directories)'";
        case ValueForm::Kind::Scene:
            return " -x -a " + fishQuoted(joined(scenes, " ") + " " + fishFiles(form));
        case ValueForm::Kind::Text:
            break;
    }
    return " -x";
}

// `condition`: of the command that the flags belong to.
std::string fishLines(const std::string& program, const Page& page, const std::string& condition,
                      const SceneIds& scenes) {
    const std::string begin = "complete -c " + program + condition;
    std::string out;
    for (const Flag& flag : page.flags) {
        std::string names;
        for (const std::string& name : flag.names)
            names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        out += begin + names + (flag.value.empty() || flag.mayOmitValue ? "" : fishValue(flag, scenes)) + " -d " +
               fishQuoted(firstPart(flag.help)) + "\n";
        if (flag.mayOmitValue) // the value is a word of its own then
            for (const std::string& name : flag.names)
                out += begin + " -n '__fish_prev_arg_in " + name + "' -a " +
                       fishQuoted(joined(formOf(flag.value).words, " ")) + "\n";
    }
    for (const Flag& argument : page.arguments) out += begin + fishValue(argument, scenes) + "\n";
    return out;
}

} // namespace

std::string fishCompletion(const Page& page, const SceneIds& scenes) {
    std::string out = "# Completion of " + page.name + " for fish.\ncomplete -c " + page.name + " -f\n";
    out += fishLines(page.name, page, page.commands.empty() ? "" : " -n __fish_use_subcommand", scenes);
    for (const Page& command : page.commands) {
        const std::string name = command.name.substr(page.name.size() + 1);
        out += "complete -c " + page.name + " -n __fish_use_subcommand -a " + name + " -d " +
               fishQuoted(command.summary) + "\n";
        out += fishLines(page.name, command, " -n '__fish_seen_subcommand_from " + name + "'", scenes);
    }
    return out;
}

} // namespace rt::manual
