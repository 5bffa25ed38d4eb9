// The volume that a shell encloses, signed: which side of its faces is the material.
//
// By the divergence theorem, the volume is a third of the integral of (p - c) . n over the faces. On each elementary
// surface that comes down to line integrals along the face's loops, so no face is ever divided up; on B-spline surfaces
// see freeform_integrals.h.
//
// Contract
//  1. signed_volume_mm3(m, s) of a closed shell whose faces look away from the enclosed space is its volume; where
//     they look into it, minus that. For edges that lie on their surfaces the error is below volume_accuracy times
//     the volume of the shell and of the balls and rings whose surfaces it uses, with B-spline faces below
//     freeform_accuracy times that.
//  2. It does not change, beyond round-off, when the model is moved; a mirroring keeps it too.
//  3. Of a shell that does not close it says nothing.
//  4. signed_area_mm2(m, f) is the face's area, negative where its loops run clockwise about its outward normal, that
//     is, where same_sense and loops contradict each other. On spheres, tori and B-spline surfaces that close like
//     them there is no telling, for the boundary of a region is that of the rest as well: there it is positive.
//  5. reverse_shell() turns a shell's faces around, loops included: the volume changes its sign.
//  6. orient_closed_shell() makes a closed shell's faces look away from the material, those of a void into it. Loops
//     agree with those next to them, same_sense is one face's word alone: where they contradict each other, the loops
//     are taken. Then the volume's sign decides.

#pragma once

#include <cstddef>

#include "kernel/brep/model.h"

namespace lyr {

// Five Gauss points on each twelfth of a turn, of integrands that vary over a turn or so.
inline constexpr double volume_accuracy = 1e-9;

double signed_volume_mm3(const Model& model, ShellId shell);

double signed_area_mm2(const Model& model, FaceId face);

void reverse_shell(Model& model, ShellId shell);

struct ShellOrientation {
    std::size_t faces_turned = 0;         // their same_sense alone
    bool is_reversed = false;             // the shell, after that
    double volume_mm3 = 0, area_mm2 = 0;  // the volume as it was stated, both to a few thousandths
};

ShellOrientation orient_closed_shell(Model& model, ShellId shell, bool is_void);

}  // namespace lyr
