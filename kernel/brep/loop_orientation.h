// Do the loops of one face agree with each other on where the face is?
//
// Contract
//  1. Afterwards the face has one side of all its loops: holes run against the outer loop, the two loops of a tube
//     against each other, and of each loop on a sphere the others are on the left.
//  2. Which of two answers, where both are consistent, is not said: turning all loops over (and with them the face)
//     is for those who know the neighbours. On a sphere there is only one.
//  3. Faces with one loop, and those on tori, stay as they are.

#pragma once

#include <cstddef>

#include "kernel/brep/model.h"

namespace lyr {

// The number of loops that have been turned over.
std::size_t make_loops_agree(Model& model, FaceId face);

void reverse_loop(Model& model, const Loop& loop);

// So that it looks the other way.
void reverse_face(Model& model, FaceId face);

}  // namespace lyr
