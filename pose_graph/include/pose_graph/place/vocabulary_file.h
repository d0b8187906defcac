#pragma once

#include <string>

#include "pose_graph/place/vocabulary.h"

namespace vins::pose_graph {

/// Reads a vocabulary, of the form that its first bytes tell: this program's, or VINS-Mono's
/// (brief_k10L6.bin). Throws InputError naming the file, and the place in it, where it cannot be
/// read, ends early or goes on too long, or holds what is no vocabulary.
///
/// This program's form, all little-endian: "VINSVOCB", four uint32 (version 1, branching, levels,
/// nodes); per node, level by level from the root, four uint64 of descriptor; per node, one uint32
/// number of children; per leaf, in the nodes' order, one float32 weight; uint64 FNV-1a checksum of
/// all bytes before it.
///
/// VINS-Mono's form, little-endian: six int32 (branching, levels, scoring, weighting, nodes without
/// the root, words); per node int32 id from 1 on, int32 parent (0: the root), float64 weight, four
/// uint64 of descriptor; per word int32 node, int32 word. Words get other numbers here.
Vocabulary readVocabulary(const std::string& path);

/// Writes a vocabulary in this program's form, aside and renamed, so that no half-written file is
/// left behind. Throws InputError naming the file where it cannot be written.
void writeVocabulary(const std::string& path, const Vocabulary& vocabulary);

}  // namespace vins::pose_graph
