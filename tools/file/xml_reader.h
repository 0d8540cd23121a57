// XML by expat, from files that may have been made to do harm.
#pragma once
#include <string>
#include <string_view>

namespace plc::tools {

// What is told of each element. May throw.
class XmlVisitor {
 public:
  using Attributes = const char**;  // name, value, name, value, ..., null

  virtual ~XmlVisitor() = default;
  virtual void start(const std::string& name, Attributes attributes) = 0;
  virtual void end(const std::string& name) = 0;
  virtual void text(std::string_view part) = 0;  // perhaps only a part of an element's text
};

// Throws Failure, its message begins with `where`: not well-formed, nested deeper than any file
// that is meant to be read, or with entities of its own, a few bytes of which stand for any number.
// What the visitor throws comes out. is_all: the document ends where the text does, else it may go
// on.
void read_xml(const std::string& where, std::string_view xml, bool is_all, XmlVisitor& visitor);

// The value of an attribute; "" where there is none.
std::string xml_attribute(XmlVisitor::Attributes attributes, const char* name);

}  // namespace plc::tools
