// Text of Wavefront files (OBJ, MTL) to statements and words, each with its place.
#pragma once

#include "dsl/report/messages.h"

#include <cstdint>
#include <string_view>

namespace patchlight {

// Goes through the text of messages.files[file], statement by statement. A statement is a line; a backslash
// at its end joins the next one to it. What is read of one is always the rest of it.
struct StatementReader {
  std::string_view text;
  uint32_t file = 0;
  size_t next = 0;         // where the next statement begins
  uint32_t next_line = 1;  // 1-based
  std::string_view rest;   // of this statement
  size_t first = 0;        // where this statement begins
  uint32_t line = 0;       // 1-based
};

StatementReader read_statements(const Messages& messages, uint32_t file);

// Moves to the next statement that is neither empty nor a comment and takes its first word; false at the end.
bool next_statement(StatementReader& reader, std::string_view& keyword);

// Takes the next word of the statement; empty where there is none.
std::string_view next_word(StatementReader& reader);

// The rest of the statement without the blanks around it: names that may have blanks inside.
std::string_view rest_of(const StatementReader& reader);

// Where a word of this statement stands.
Place place_of(const StatementReader& reader, std::string_view word);

// Takes the next word as a finite number. False after an error: mesh-invalid, non-finite,
// number-out-of-range.
bool next_number(Messages& messages, StatementReader& reader, double& value);

}  // namespace patchlight
