// stillframe completion bash: a script that is made from the options' declarations, so that it
// knows what this very program knows.

#include <algorithm>
#include <memory>

#include "demos/scenes/builtin.h"
#include "demos/stillframe/cli.h"
#include "demos/stillframe/report.h"
#include "postfx/policy.h"
#include "rasterizer/simd.h"

namespace still::command {
namespace {

// The line is cut at blanks here, because bash also cuts it at ':' and '='. What stands before the
// last of these in the word is taken off the answers, as readline wants it.
constexpr const char* kFunction = R"bash(
_stillframe() {
    local line=${COMP_LINE:0:COMP_POINT} command= previous= files= words= typed word
    read -ra typed <<<"$line"
    local current=
    [[ $line == *[[:space:]] ]] || { current=${typed[-1]}; unset 'typed[-1]'; }
    for word in "${typed[@]:1}"; do
        case "$command/$word" in
            @SUBCOMMANDS@) command="$command/$word" ;;
        esac
        previous=$word
    done
    if [[ $current == --*=* ]]; then
        previous=${current%%=*}
        current=${current#*=}
    fi
    case "$command $previous" in
@VALUES@
        *)
            case "$command" in
@COMMANDS@
            esac
            [[ $current == -* ]] && files= ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    if [[ $files ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
    fi
    if [[ $current == *:* && $COMP_WORDBREAKS == *:* ]]; then
        COMPREPLY=("${COMPREPLY[@]#"${current%:*}:"}")
    fi
}
complete -F _stillframe stillframe
)bash";

std::string replaced(std::string text, const std::string& place, const std::string& with) {
    return text.replace(text.find(place), place.size(), with);
}

template <class Range, class NameOf>
std::string wordsOf(const Range& range, NameOf&& nameOf) {
    std::string words;
    for (const auto& element : range) {
        words += (words.empty() ? "" : " ") + std::string(nameOf(element));
    }
    return words;
}

std::string sceneWords() {
    return wordsOf(builtinSceneNames(), [](const std::string& name) { return "builtin:" + name; });
}

/// What can stand after an option: a shell command that says so.
std::string valueOf(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const size_t open = type.find('{'), close = type.find('}');
    if (open != std::string::npos && close != std::string::npos) {  // CLI::IsMember
        std::string words = type.substr(open + 1, close - open - 1);
        std::replace(words.begin(), words.end(), ',', ' ');
        return "words='" + words + "'";
    }
    if (type.starts_with("MODE")) {
        return "words='none taa fxaa ssaa:64 " +
               wordsOf(taaPresets(),
                       [](const TaaPreset& p) { return "taa:" + std::string(p.name); }) +
               "'";
    }
    if (type.starts_with("TARGET")) {
        return "words='" +
               wordsOf(availableSimdTargets(), [](SimdTarget target) { return name(target); }) +
               "'";
    }
    const bool file =
        type == "NAME" || type == "NAME.png" || type == "FILE" || type == "DIR" || type == "FOLDER";
    return file ? "files=1" : ":";
}

/// What can stand where no option does, after the words that are offered there.
std::string positionalOf(const CLI::Option& option) {
    if (option.get_name() == "SCENE") {
        return " " + sceneWords() + "'; files=1";
    }
    const std::string value = valueOf(option);
    return "'; " + (value == ":" ? "files=1" : value);
}

std::vector<std::string> namesOf(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) {
        names.push_back("--" + name);
    }
    for (const std::string& name : option.get_snames()) {
        names.push_back("-" + name);
    }
    return names;
}

/// The parts of the script, gathered over all commands.
struct Script {
    std::vector<std::string> subcommands;
    std::string values, commands;

    /// `path` is "" for the program, "/render", "/golden/record" …
    void add(const CLI::App& app, const std::string& path);
};

void Script::add(const CLI::App& app, const std::string& path) {
    std::string words, positional;
    for (const CLI::Option* option : app.get_options()) {
        const std::vector<std::string> names = namesOf(*option);
        if (names.empty()) {
            positional = positionalOf(*option);
        }
        words += " " + wordsOf(names, [](const std::string& name) { return name; });
        for (const std::string& name : names) {
            if (option->get_items_expected_max() > 0) {
                values += "        '" + path + " " + name + "') " + valueOf(*option) + " ;;\n";
            }
        }
    }
    for (const CLI::App* subcommand : app.get_subcommands({})) {
        words += " " + subcommand->get_name();
        subcommands.push_back(path + "/" + subcommand->get_name());
        add(*subcommand, path + "/" + subcommand->get_name());
    }
    commands += "                '" + path + "') words='" + words +
                (positional.empty() ? "'" : positional) + " ;;\n";
}

std::string bashScript(const CLI::App& app) {
    Script script;
    script.add(app, "");
    std::string paths;
    for (const std::string& path : script.subcommands) {
        paths += (paths.empty() ? "'" : "|'") + path + "'";
    }
    std::string text = replaced(kFunction, "@SUBCOMMANDS@", paths);
    text = replaced(text, "@VALUES@\n", script.values);
    text = replaced(text, "@COMMANDS@\n", script.commands);
    return "# bash completion for stillframe, printed by: stillframe completion bash\n" + text;
}

}  // namespace

Subcommand declareCompletion(CLI::App& app) {
    const auto shell = std::make_shared<std::string>();
    CLI::App* completion = app.add_subcommand(
        "completion", "Print a script for the shell: source <(stillframe completion bash)");
    completion->add_option("SHELL", *shell, "bash")
        ->required()
        ->check(CLI::IsMember({"bash"}))
        ->type_name("");
    return {completion, [&app, shell](Interruption&) {  // `shell` is what parsing fills in
                return print(bashScript(app)).map([] { return ExitCode::ok; });
            }};
}

}  // namespace still::command
