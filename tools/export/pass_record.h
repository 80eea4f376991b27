// What a run keeps of each pass for a format that shows all of them: a word a vertex and a word an element.
#pragma once

#include "engine/solve/solvers.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

constexpr uint32_t kRecordedPassesMax = 16;  // and the last one

// Columns of RGB9E5 words, of radiosity times 2^EV: 1 is display white.
struct PassRecord {
  const Solver* solver = &solvers()[0];
  std::vector<uint32_t> pass;                 // which, ascending
  std::vector<std::vector<uint32_t>> vertex;  // a row a recorded pass: a word a row of element_vertices
  std::vector<std::vector<uint32_t>> element;
  size_t size() const { return pass.size(); }
};

// After a step: keeps it if it is one of the first 16 or the last one; where steps are many and small, as
// shots are, numbers 1, 2, 4, 8 ... and the last one. EV is what 1 in the record stands for; ambient goes
// with vertex_radiosity().
void record_pass(PassRecord& record, const Solution& solution, Rgb ambient, double ev, bool last);

// Three numbers of nine bits that share an exponent of five, as OpenGL packs GL_RGB9_E5 (extension
// EXT_texture_shared_exponent): red in the lowest bits. Within 2^-10 of the largest of the three; what is
// above 65408 becomes 65408, what is below 0 or no number becomes 0.
uint32_t pack_shared_exponent(Rgb value);
Rgb unpack_shared_exponent(uint32_t word);

}  // namespace patchlight
