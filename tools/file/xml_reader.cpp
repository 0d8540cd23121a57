#include "tools/file/xml_reader.h"

#include <expat.h>

#include <cstring>
#include <exception>
#include <limits>
#include <memory>

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

constexpr int kDeepest = 64;

// Between expat, which is C, and the visitor, which may throw: exceptions wait until expat is left.
class Session {
 public:
  Session(XML_Parser parser, XmlVisitor& visitor) : parser_(parser), visitor_(visitor) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(parser, on_start, on_end);
    XML_SetCharacterDataHandler(parser, on_text);
    XML_SetEntityDeclHandler(parser, on_entity);
  }

  void rethrow() const {
    if (thrown_ != nullptr) std::rethrow_exception(thrown_);
  }
  // "": expat's own error says it.
  const char* refusal() const { return refusal_; }

 private:
  static void on_start(void* self, const char* name, const char** attributes) {
    auto* session = static_cast<Session*>(self);
    if (++session->depth_ > kDeepest) return session->refuse("is nested too deeply");
    session->guarded([&] { session->visitor_.start(name, attributes); });
  }
  static void on_end(void* self, const char* name) {
    auto* session = static_cast<Session*>(self);
    --session->depth_;
    session->guarded([&] { session->visitor_.end(name); });
  }
  static void on_text(void* self, const char* part, int size) {
    auto* session = static_cast<Session*>(self);
    session->guarded([&] { session->visitor_.text({part, static_cast<size_t>(size)}); });
  }
  static void on_entity(void* self, const char*, int, const char*, int, const char*, const char*,
                        const char*, const char*) {
    static_cast<Session*>(self)->refuse("has entities of its own");
  }

  template <typename Work>
  void guarded(const Work& work) {
    if (thrown_ != nullptr || *refusal_ != '\0') return;  // expat may call once more
    try {
      work();
    } catch (...) {
      thrown_ = std::current_exception();
      XML_StopParser(parser_, XML_FALSE);
    }
  }
  void refuse(const char* message) {
    refusal_ = message;
    XML_StopParser(parser_, XML_FALSE);
  }

  XML_Parser parser_;
  XmlVisitor& visitor_;
  int depth_ = 0;
  const char* refusal_ = "";
  std::exception_ptr thrown_;
};

}  // namespace

void read_xml(const std::string& where, std::string_view xml, bool is_all, XmlVisitor& visitor) {
  if (xml.size() > size_t{std::numeric_limits<int>::max()}) {
    throw Failure{where + ": is too large for its encoding"};
  }
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  if (parser == nullptr) throw Failure{where + ": not enough memory to read it"};
  Session session(parser.get(), visitor);
  const XML_Status status =
      XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), is_all ? 1 : 0);
  session.rethrow();
  if (status == XML_STATUS_OK) return;
  const std::string line =
      where + ": line " + std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": its XML ";
  if (*session.refusal() != '\0') throw Failure{line + session.refusal()};
  throw Failure{line + "is damaged (" + XML_ErrorString(XML_GetErrorCode(parser.get())) + ")"};
}

std::string xml_attribute(XmlVisitor::Attributes attributes, const char* name) {
  for (; *attributes != nullptr; attributes += 2) {
    if (std::strcmp(*attributes, name) == 0) return attributes[1];
  }
  return {};
}

}  // namespace plc::tools
