// XML for this folder's own .cpp files: a document that knows the lines of its elements.
#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>

namespace legible {

class XmlText {
 public:
  // Throws InputError where the text is no XML.
  XmlText(const std::filesystem::path& file, const std::string& text);

  pugi::xml_node Root() const { return document_.document_element(); }
  int LineOf(const pugi::xml_node& node) const;

  // Throws InputError: "<name> what is wrong; what to do" at the element's line.
  [[noreturn]] void Fail(const pugi::xml_node& node, const std::string& what_is_wrong,
                         const std::string& what_to_do) const;
  // The child of that name, once. Fails otherwise.
  pugi::xml_node Get(const pugi::xml_node& parent, const char* name) const;
  // The text of an element as a finite number. Fails otherwise.
  double Number(const pugi::xml_node& node) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  pugi::xml_document document_;
};

}  // namespace legible
