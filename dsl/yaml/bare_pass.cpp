// yaml-cpp's events, counted.
#include "dsl/yaml/bare_pass.h"

#include "dsl/report/diagnostics.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <sstream>

namespace patchlight {
namespace {

struct EventCounter : YAML::EventHandler {
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;
  uint64_t count = 0;
  void OnDocumentStart(const Mark&) override { ++count; }
  void OnDocumentEnd() override { ++count; }
  void OnNull(const Mark&, Anchor) override { ++count; }
  void OnAlias(const Mark&, Anchor) override { ++count; }
  void OnScalar(const Mark&, const std::string&, Anchor, const std::string&) override { ++count; }
  void OnSequenceStart(const Mark&, const std::string&, Anchor, Style) override { ++count; }
  void OnSequenceEnd() override { ++count; }
  void OnMapStart(const Mark&, const std::string&, Anchor, Style) override { ++count; }
  void OnMapEnd() override { ++count; }
};

}  // namespace

uint64_t count_yaml_events(const std::string& text) {
  EventCounter counter;
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(counter);
  } catch (const YAML::Exception& error) {
    throw UserError("yaml-syntax", escape_text(error.what(), 200));
  }
  return counter.count;
}

}  // namespace patchlight
