// All cases of the function parity check, in which host and GPU must agree to the bit, by function and precision.
#pragma once

#include "testing/parity/function_cases_convex.h"
#include "testing/parity/function_cases_elementary.h"
#include "testing/parity/function_cases_light.h"
#include "testing/parity/function_cases_portable.h"
#include "testing/parity/function_cases_refraction.h"
#include "testing/parity/function_cases_round.h"
#include "testing/parity/function_cases_sums.h"
#include "testing/parity/function_cases_triangle.h"

namespace cistula::parity {

using NumberCases =
    CaseList<ReciprocalCase<float>, ReciprocalCase<double>, LesserGreaterCase<float>, LesserGreaterCase<double>,
             Exp2Case, Log2Case, Log2PairCase, PowCase, SinCase, CosCase, TanCase, SrgbCase, PowerBySquaringCase<float>,
             PowerBySquaringCase<double>, DoubleDoubleCase, ToFixedCase<float>, ToFixedCase<double>, ResolveCase<float>,
             ResolveCase<double>, LossCase, TransmittanceCase<float>, TransmittanceCase<double>, AbsorptionCase,
             PathSumCase>;

using LightCases = CaseList<VectorCase<float>, VectorCase<double>, RefractCase<float>, RefractCase<double>,
                            FresnelCase<float>, FresnelCase<double>, ReflectCase<float>, ReflectCase<double>,
                            PhongCase<float>, PhongCase<double>, CameraCase, TextureCase<float>, TextureCase<double>,
                            VisibleLightCase<float>, VisibleLightCase<double>, ApexCase<float>, ApexCase<double>>;

using HitCases = CaseList<TriangleCase<float>, TriangleCase<double>, TriangleShadowCase<float>,
                          TriangleShadowCase<double>, ConvexCase<float>, ConvexCase<double>, ConvexIntervalCase<float>,
                          ConvexIntervalCase<double>, ConvexShadowCase<float>, ConvexShadowCase<double>,
                          BallCase<float>, BallCase<double>, DiskCase<float>, DiskCase<double>>;

template <class... A, class... B, class... C>
CaseList<A..., B..., C...> joined(CaseList<A...>, CaseList<B...>, CaseList<C...>);

using AllCases = decltype(joined(NumberCases(), LightCases(), HitCases()));

}  // namespace cistula::parity
