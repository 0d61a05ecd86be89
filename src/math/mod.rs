//! Sines and their like, which give the same bits on every machine.
//!
//! The functions of the standard library are those of the machine's C library, which round the last digit as they like: a model of the
//! program would differ from that of the browser, and even in its number of triangles where a digit decides. Here they are computed
//! by the crate `libm`, in arithmetic that is exact everywhere. `sqrt`, `abs`, `floor` and their like are exact in the standard library
//! too, and `powi` multiplies.

mod turns;

pub(crate) use turns::{
    angle_between, angle_between_turns, angle_to, direction, euler_zyx, rotation, rotation_along,
    rotation_around, rotation_x, rotation_y, rotation_z, slerp,
};

/// A number of one of the two sizes.
pub(crate) trait Real: Sized {
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn tan(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn asin(self) -> Self;
    fn acos(self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn exp(self) -> Self;
    fn exp2(self) -> Self;
    fn ln(self) -> Self;
    fn log2(self) -> Self;
    fn log10(self) -> Self;
    fn powf(self, exponent: Self) -> Self;
    fn cbrt(self) -> Self;
    fn hypot(self, other: Self) -> Self;
}

macro_rules! real {
    ($number:ty: $sin:ident $cos:ident $tan:ident $sin_cos:ident $asin:ident $acos:ident $atan2:ident $exp:ident $exp2:ident $ln:ident
        $log2:ident $log10:ident $powf:ident $cbrt:ident $hypot:ident) => {
        impl Real for $number {
            #[inline]
            fn sin(self) -> Self {
                libm::$sin(self)
            }
            #[inline]
            fn cos(self) -> Self {
                libm::$cos(self)
            }
            #[inline]
            fn tan(self) -> Self {
                libm::$tan(self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                libm::$sin_cos(self)
            }
            #[inline]
            fn asin(self) -> Self {
                libm::$asin(self)
            }
            #[inline]
            fn acos(self) -> Self {
                libm::$acos(self)
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline]
            fn exp(self) -> Self {
                libm::$exp(self)
            }
            #[inline]
            fn exp2(self) -> Self {
                libm::$exp2(self)
            }
            #[inline]
            fn ln(self) -> Self {
                libm::$ln(self)
            }
            #[inline]
            fn log2(self) -> Self {
                libm::$log2(self)
            }
            #[inline]
            fn log10(self) -> Self {
                libm::$log10(self)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                libm::$powf(self, exponent)
            }
            #[inline]
            fn cbrt(self) -> Self {
                libm::$cbrt(self)
            }
            #[inline]
            fn hypot(self, other: Self) -> Self {
                libm::$hypot(self, other)
            }
        }
    };
}

real!(f32: sinf cosf tanf sincosf asinf acosf atan2f expf exp2f logf log2f log10f powf cbrtf hypotf);
real!(f64: sin cos tan sincos asin acos atan2 exp exp2 log log2 log10 pow cbrt hypot);

/// The sine of an angle in radians.
#[inline]
pub(crate) fn sin<T: Real>(angle: T) -> T {
    Real::sin(angle)
}

/// The cosine of an angle in radians.
#[inline]
pub(crate) fn cos<T: Real>(angle: T) -> T {
    Real::cos(angle)
}

/// The tangent of an angle in radians.
#[inline]
pub(crate) fn tan<T: Real>(angle: T) -> T {
    Real::tan(angle)
}

/// The sine and the cosine of an angle in radians.
#[inline]
pub(crate) fn sin_cos<T: Real>(angle: T) -> (T, T) {
    Real::sin_cos(angle)
}

/// The angle, in radians between -π/2 and π/2, whose sine is `x`.
#[inline]
pub(crate) fn asin<T: Real>(x: T) -> T {
    Real::asin(x)
}

/// The angle, in radians between 0 and π, whose cosine is `x`.
#[inline]
pub(crate) fn acos<T: Real>(x: T) -> T {
    Real::acos(x)
}

/// The angle of the point (x, y) from the x axis, in radians between -π and π.
#[inline]
pub(crate) fn atan2<T: Real>(y: T, x: T) -> T {
    Real::atan2(y, x)
}

/// e to the power of `x`.
#[inline]
pub(crate) fn exp<T: Real>(x: T) -> T {
    Real::exp(x)
}

/// 2 to the power of `x`.
#[inline]
pub(crate) fn exp2<T: Real>(x: T) -> T {
    Real::exp2(x)
}

/// The logarithm to base e.
#[inline]
pub(crate) fn ln<T: Real>(x: T) -> T {
    Real::ln(x)
}

/// The logarithm to base 2.
#[inline]
pub(crate) fn log2<T: Real>(x: T) -> T {
    Real::log2(x)
}

/// The logarithm to base 10.
#[inline]
pub(crate) fn log10<T: Real>(x: T) -> T {
    Real::log10(x)
}

/// `base` to the power of `exponent`.
#[inline]
pub(crate) fn powf<T: Real>(base: T, exponent: T) -> T {
    Real::powf(base, exponent)
}

/// The cube root.
#[inline]
pub(crate) fn cbrt<T: Real>(x: T) -> T {
    Real::cbrt(x)
}

/// The length of the vector (x, y), without overflow between.
#[inline]
pub(crate) fn hypot<T: Real>(x: T, y: T) -> T {
    Real::hypot(x, y)
}
