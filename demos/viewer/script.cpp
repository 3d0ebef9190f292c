#include "demos/viewer/script.h"

#include <SDL_stdinc.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <optional>
#include <string_view>

#include "demos/stillframe/options.h"

namespace still::viewer {
namespace {

using command::Outcome;
using command::usageError;
using Kind = ScriptStep::Kind;

constexpr int kFarthest = 100000;  // pixels, frames
constexpr int kDragFrames = 8;

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        const size_t begin = line.find_first_not_of(" \t\r");
        if (begin == std::string_view::npos) {
            return words;
        }
        const size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        line.remove_prefix(end);
    }
}

/// Reads the words after the command into the step; false when they are not what `form` says.
using Reader = bool (*)(const std::vector<std::string_view>& words, ScriptStep& step);
struct Command {
    std::string_view name;  ///< the first word, or the first two
    Kind kind;
    std::string_view form;  ///< the words after it, for messages
    size_t fewest, most;    ///< of those words
    Reader read;
};

bool readNumber(std::string_view word, int low, int& out) {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < low ||
        value > kFarthest) {
        return false;
    }
    out = value;
    return true;
}

bool readPlace(const std::vector<std::string_view>& words, size_t first, int& x, int& y) {
    return readNumber(words[first], -kFarthest, x) && readNumber(words[first + 1], -kFarthest, y);
}

/// The word of that number, or left when there are no more.
bool readButton(const std::vector<std::string_view>& words, size_t index, ScriptStep& step) {
    if (index == words.size()) {
        return true;
    }
    const std::string_view name = words[index];
    step.button = name == "middle"  ? MouseButton::middle
                  : name == "right" ? MouseButton::right
                                    : MouseButton::left;
    return name == "left" || name == "middle" || name == "right";
}

using Words = std::vector<std::string_view>;

bool readKey(const Words& words, ScriptStep& step) {
    const auto key = keyNamed(words[0]);
    step.key = key.value_or(Key{});
    return key.has_value();
}

bool readFile(const Words& words, ScriptStep& step) {
    // The rest of the line: names may have blanks.
    step.file.assign(words.front().data(), words.back().data() + words.back().size());
    return true;
}

bool readSize(const Words& words, ScriptStep& step) {
    const auto size = command::parseResolution(std::string(words[0]));
    if (size) {
        step.x = size->width;
        step.y = size->height;
    }
    return size.has_value();
}

constexpr size_t kManyWords = 1000;
constexpr std::array kCommands{
    Command{"key", Kind::key, "NAME, as in ctrl+q", 1, 1, readKey},
    Command{"keydown", Kind::key_down, "NAME", 1, 1, readKey},
    Command{"keyup", Kind::key_up, "NAME", 1, 1, readKey},
    Command{"mouse move", Kind::mouse_move, "X Y", 2, 2,
            [](const Words& words, ScriptStep& s) { return readPlace(words, 0, s.x, s.y); }},
    Command{"mouse down", Kind::mouse_down, "[left|middle|right]", 0, 1,
            [](const Words& words, ScriptStep& s) { return readButton(words, 0, s); }},
    Command{"mouse up", Kind::mouse_up, "[left|middle|right]", 0, 1,
            [](const Words& words, ScriptStep& s) { return readButton(words, 0, s); }},
    Command{"mouse click", Kind::mouse_click, "X Y [left|middle|right]", 2, 3,
            [](const Words& words, ScriptStep& s) {
                return readPlace(words, 0, s.x, s.y) && readButton(words, 2, s);
            }},
    Command{"mouse drag", Kind::mouse_drag, "X Y TO_X TO_Y [left|middle|right]", 4, 5,
            [](const Words& words, ScriptStep& s) {
                return readPlace(words, 0, s.x, s.y) && readPlace(words, 2, s.to_x, s.to_y) &&
                       readButton(words, 4, s);
            }},
    Command{"mouse wheel", Kind::mouse_wheel, "NOTCHES", 1, 1,
            [](const Words& words, ScriptStep& s) { return readNumber(words[0], -100, s.count); }},
    Command{"drop", Kind::drop, "FILE", 1, kManyWords, readFile},
    Command{"resize", Kind::resize, "WIDTHxHEIGHT", 1, 1, readSize},
    Command{"wait", Kind::wait, "FRAMES", 1, 1,
            [](const Words& words, ScriptStep& s) { return readNumber(words[0], 1, s.count); }},
    Command{"screenshot", Kind::screenshot, "NAME.png", 1, kManyWords,
            [](const Words& words, ScriptStep& s) {
                return readFile(words, s) && s.file.ends_with(".png");
            }},
    Command{"quit", Kind::quit, "nothing more", 0, 0,
            [](const Words&, ScriptStep&) { return true; }},
};

/// The command that the words begin with; takes its name off them.
const Command* takeCommand(Words& words) {
    for (const Command& command : kCommands) {
        const size_t blank = command.name.find(' ');
        const size_t length = blank == std::string_view::npos ? 1 : 2;
        if (words.size() < length || words[0] != command.name.substr(0, blank) ||
            (length == 2 && words[1] != command.name.substr(blank + 1))) {
            continue;
        }
        words.erase(words.begin(), words.begin() + ptrdiff_t(length));
        return &command;
    }
    return nullptr;
}

std::string commandNames() {
    std::string names;
    for (const Command& command : kCommands) {
        names += (names.empty() ? "" : ", ") + std::string(command.name);
    }
    return names;
}

Outcome<ScriptStep> parseLine(std::string_view line, const std::string& where) {
    Words words = wordsOf(line);
    const Command* command = takeCommand(words);
    if (command == nullptr) {
        return usageError(where + ": unknown command, expected one of " + commandNames());
    }
    ScriptStep step;
    step.kind = command->kind;
    if (words.size() < command->fewest || words.size() > command->most ||
        !command->read(words, step)) {
        return usageError(where + ": expected " + std::string(command->name) + " " +
                          std::string(command->form));
    }
    return step;
}

SDL_Event windowSize(int width, int height) {
    SDL_Event event{};
    event.type = SDL_WINDOWEVENT;
    event.window.event = SDL_WINDOWEVENT_SIZE_CHANGED;
    event.window.data1 = width;
    event.window.data2 = height;
    return event;
}

SDL_Event dropped(const std::string& file) {
    SDL_Event event{};
    event.type = SDL_DROPFILE;
    event.drop.file = SDL_strdup(file.c_str());
    return event;
}

SDL_Event wheel(int notches) {
    SDL_Event event{};
    event.type = SDL_MOUSEWHEEL;
    event.wheel.y = notches;
    event.wheel.preciseY = float(notches);
    return event;
}

uint16_t modifierOf(SDL_Keycode code) {
    switch (code) {
        case SDLK_LSHIFT:
            return KMOD_LSHIFT;
        case SDLK_LCTRL:
            return KMOD_LCTRL;
        case SDLK_LALT:
            return KMOD_LALT;
        default:
            return 0;
    }
}

}  // namespace

Outcome<std::vector<ScriptStep>> parseScript(const std::string& text, const std::string& file) {
    std::vector<ScriptStep> steps;
    std::string_view rest = text;
    for (int number = 1; !rest.empty(); ++number) {
        const size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const Words words = wordsOf(line);
        if (words.empty() || words[0].starts_with('#')) {
            continue;
        }
        Outcome<ScriptStep> step = parseLine(line, file + ":" + std::to_string(number));
        if (!step) {
            return tl::make_unexpected(step.error());
        }
        steps.push_back(std::move(*step));
    }
    return steps;
}

SDL_Event ScriptPlayer::keyEvent(const Key& key, bool down) {
    const uint16_t own = modifierOf(key.code);
    modifiers_ = uint16_t(down ? modifiers_ | own : modifiers_ & ~own);
    SDL_Event event{};
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
    event.key.keysym.sym = key.code;
    event.key.keysym.scancode = SDL_GetScancodeFromKey(key.code);
    event.key.keysym.mod = uint16_t(modifiers_ | (key.ctrl ? KMOD_LCTRL : 0) |
                                    (key.shift ? KMOD_LSHIFT : 0) | (key.alt ? KMOD_LALT : 0));
    return event;
}

SDL_Event ScriptPlayer::buttonEvent(MouseButton button, bool down) const {
    SDL_Event event{};
    event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
    event.button.button = uint8_t(button);
    event.button.state = down ? SDL_PRESSED : SDL_RELEASED;
    event.button.clicks = 1;
    event.button.x = x_;
    event.button.y = y_;
    return event;
}

SDL_Event ScriptPlayer::motionTo(int x, int y) {
    SDL_Event event{};
    event.type = SDL_MOUSEMOTION;
    event.motion.x = x;
    event.motion.y = y;
    event.motion.xrel = x - x_;
    event.motion.yrel = y - y_;
    x_ = x;
    y_ = y;
    return event;
}

std::vector<std::vector<SDL_Event>> ScriptPlayer::drag(const ScriptStep& step) {
    std::vector<std::vector<SDL_Event>> frames{{motionTo(step.x, step.y)},
                                               {buttonEvent(step.button, true)}};
    for (int i = 1; i <= kDragFrames; ++i) {
        frames.push_back({motionTo(step.x + (step.to_x - step.x) * i / kDragFrames,
                                   step.y + (step.to_y - step.y) * i / kDragFrames)});
    }
    frames.push_back({buttonEvent(step.button, false)});
    return frames;
}

std::vector<std::vector<SDL_Event>> ScriptPlayer::eventsOf(const ScriptStep& step) {
    switch (step.kind) {
        case Kind::key: {
            const SDL_Event down = keyEvent(step.key, true);
            return {{down}, {keyEvent(step.key, false)}};
        }
        case Kind::key_down:
            return {{keyEvent(step.key, true)}};
        case Kind::key_up:
            return {{keyEvent(step.key, false)}};
        case Kind::mouse_move:
            return {{motionTo(step.x, step.y)}};
        case Kind::mouse_down:
            return {{buttonEvent(step.button, true)}};
        case Kind::mouse_up:
            return {{buttonEvent(step.button, false)}};
        case Kind::mouse_click: {
            // One after the other: the panels must have seen the mouse arrive.
            const SDL_Event move = motionTo(step.x, step.y);
            return {{move}, {buttonEvent(step.button, true)}, {buttonEvent(step.button, false)}};
        }
        case Kind::mouse_drag:
            return drag(step);
        case Kind::mouse_wheel:
            return {{wheel(step.count)}};
        case Kind::drop:
            return {{dropped(step.file)}};
        case Kind::resize:
            return {{windowSize(step.x, step.y)}};
        case Kind::wait:
            return std::vector<std::vector<SDL_Event>>(size_t(step.count));
        case Kind::screenshot:
        case Kind::quit:
            return {};
    }
    return {};
}

}  // namespace still::viewer
