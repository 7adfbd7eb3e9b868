// Reading text: whole files, numbers, names that were meant.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace legible {

// The file's bytes. Throws InputError if it cannot be read.
std::string ReadBytes(const std::filesystem::path& file);

// The file's text without a byte-order mark. Throws InputError if it cannot be read, is empty or is no text.
std::string ReadTextFile(const std::filesystem::path& file);

// Without white space (a carriage return too) at both ends.
std::string_view Trimmed(std::string_view text);

// With blanks for line ends and other control characters: what a file holds is quoted, and may hold anything.
std::string OneLine(std::string text);

// The first line, of at most some 60 bytes; "…" stands for what is left out. For messages: a file's whole
// content may have been taken for one value.
std::string Shortened(std::string_view text);

// A finite decimal number that takes up the whole of `text`; nothing otherwise.
std::optional<double> ParseFinite(std::string_view text);
std::optional<int> ParseInteger(std::string_view text);

// The one of `known` (not empty) with the fewest letters to change from `name` (Levenshtein's distance).
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

}  // namespace legible
