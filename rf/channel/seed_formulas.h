// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The formulas of the published system that this project grew from, beside ours. No code: what stands where.
//
// Great-X: K. Huang, S. Mu, J. Jiang, Y. Gao, S. Xu, "Unreal is all you need: Multimodal ISAC Data Simulation with Only One
// Engine", arXiv:2507.08716, 2025. It rebuilds the ray tracing of Sionna RT, whose formulas are published and numbered:
// "Primer on Electromagnetics" in the documentation of Sionna (J. Hoydis et al., arXiv:2303.11103). Numbers below are the
// primer's; its phasors are peak values, ours rms. tests/rf/channel_seed_test.cpp works the left column out by code of its
// own, path by path, and holds ours against it.
//
// Great-X and the primer                                     | here                                          | differences
// -----------------------------------------------------------|-----------------------------------------------|------------
// E_T = sqrt(P_T G_T Z_0/2 pi) e^{-j k r}/r F_T         (15) | received(): sqrt(eta_0 P_t/4 pi) T C_T        | peak = sqrt(2)
//                                                            | e^{-j 2 pi f tau}, C = sqrt(G) F              | x rms
// W(a, b, q, r) = [a.q a.r; b.q b.r]                    (30) | path_field(): vectors in three dimensions,    | none: W is
//   turns components on (q, r) into those on (a, b)          | resolved on s = k x n/|k x n| and p = k x s   | the change
//                                                            | at each wall                                  | of basis
// E_perp = (k_i x n)/|k_i x n|, E_par = E_perp x k_i    (29) | s the same, p = -E_par                        | sign of p,
//                                                            |                                               | before and
//                                                            |                                               | after: none
// r_perp, r_par from vacuum                             (34) | half_space(), r_TE and r_TM of P.2040-4       | none; walls
//                                                            |                                               | with a
//                                                            |                                               | thickness are
//                                                            |                                               | slabs here
// E_R = [prod_i W_i diag(r_perp, r_par)_i] W_0 E_T      (22) | Path::transfer, row-major, without the phase  | none
// a factor for the humidity of the air on each path          | PathAttenuation: 10^{-gamma d/20}, gamma of   | ours is
//                                                            | P.676-13 line by line: temperature, pressure  | P.676's; the
//                                                            | and vapour (rf/atmosphere/gas.h)              | paper's own
//                                                            |                                               | coefficient
//                                                            |                                               | is not used
// V_R = sqrt(lambda^2/4 pi 4 Re Z_R/Z_0) C_R^H E_R      (21) | received(): sqrt(4 R P_t) a                   | peak; C_R
// V_R = sqrt((lambda/4 pi)^2 P_T 8 Re Z_R) C_R^H T C_T  (23) |                                               | below
// P_R = |V_R|^2/(8 Re Z_R)                              (20) | received(): P_t |a|^2 = |V_oc|^2/(4 R)        | peak
// H(f) = V_R/V_T = sum (lambda/4 pi) C_R^H T_i C_T           | frequency_response(), with array phases,      | Delta f on
//        e^{-j 2 pi f tau_i}                        (24, 26) | Doppler, exact turns                          | the carrier's
//                                                            |                                               | lambda/4 pi
// h_b(tau) = sum a_i e^{-j 2 pi f tau_i} delta(tau - tau_i)  | impulse_response()                            | none
//                                                       (28) |                                               |
//
// C_R: the primer puts the same F in C_R^H as in C_T. We put the conjugate of what the port radiates, F_R^T by reciprocity
// (rf/channel/frequency_response.h). Real patterns do not tell the two apart; two equal circularly polarized antennas do:
// they see each other here, and would not with F_R^H.
#pragma once
