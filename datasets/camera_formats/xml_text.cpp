#include "datasets/camera_formats/xml_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

int LineAt(const std::string& text, std::ptrdiff_t offset) {
  const auto end = text.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

}  // namespace

XmlText::XmlText(const std::filesystem::path& file, const std::string& text) : file_(file), text_(text) {
  const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
  if (!result)
    throw InputError(file_, LineAt(text_, result.offset), fmt::format("is no XML: {}", result.description()),
                     "mend the syntax at this line");
}

int XmlText::LineOf(const pugi::xml_node& node) const { return LineAt(text_, node.offset_debug()); }

void XmlText::Fail(const pugi::xml_node& node, const std::string& what_is_wrong,
                   const std::string& what_to_do) const {
  throw InputError(file_, LineOf(node), fmt::format("<{}> {}", node.name(), what_is_wrong), what_to_do);
}

pugi::xml_node XmlText::Get(const pugi::xml_node& parent, const char* name) const {
  const pugi::xml_node child = parent.child(name);
  if (!child) Fail(parent, fmt::format("has no <{}>", name), "add it");
  if (const pugi::xml_node again = child.next_sibling(name)) Fail(again, "is there twice", "keep one");
  return child;
}

double XmlText::Number(const pugi::xml_node& node) const {
  const std::optional<double> value = ParseFinite(Trimmed(node.text().get()));
  if (!value) Fail(node, fmt::format("is \"{}\", not a finite number", node.text().get()), "give a number");
  return *value;
}

}  // namespace legible
