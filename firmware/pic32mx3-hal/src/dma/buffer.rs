//! Memory that a channel can be given: it stays where it is, and nobody else has it meanwhile.

use crate::cpu;
use crate::word::RegisterWord;
use core::cell::UnsafeCell;
use core::fmt;
use core::ptr::NonNull;
use core::sync::atomic::{AtomicBool, Ordering};

/// What a channel moves: `u8`, `u16` or `u32`. Every pattern of bits is one.
pub trait Element: RegisterWord + Send {
    /// The byte that it is; nothing when it is longer.
    #[doc(hidden)]
    fn to_byte(self) -> Option<u8>;
}

/// Memory that a channel may read: a reference for good to elements, in RAM or flash. What is forgotten or leaked while a channel
/// reads it is still there.
pub trait ReadBuffer: sealed::Buffer + Send {
    /// What is in it.
    type Element: Element;
    /// Gives it up.
    #[doc(hidden)]
    fn lend(self) -> Lent<Self::Element>;
    /// Takes it back.
    ///
    /// # Safety
    /// What it gets came out of `lend` of the same type, once, and no channel uses it any more.
    #[doc(hidden)]
    unsafe fn reclaim(lent: Lent<Self::Element>) -> Self;
}

/// Memory that a channel may write: the only reference to it, for good.
pub trait WriteBuffer: ReadBuffer {}

/// A buffer without its owner.
#[doc(hidden)]
#[derive(Debug)]
pub struct Lent<W> {
    start: NonNull<W>,
    /// Elements that are moved.
    length: usize,
    /// Elements that the reference has.
    whole: usize,
}

// SAFETY: it stands for the reference that it was made of, to elements that are `Send`, and gives no access by itself.
unsafe impl<W: Element> Send for Lent<W> {}

impl<W: Element> Lent<W> {
    /// How many elements.
    pub(super) const fn len(&self) -> usize {
        self.length
    }

    /// How many bytes.
    pub(super) const fn bytes(&self) -> usize {
        self.length * size_of::<W>()
    }

    /// Where the DMA controller finds it: the three highest bits say only how the processor gets there.
    pub(super) fn physical_address(&self) -> u32 {
        self.start.as_ptr().expose_provenance() as u32 & 0x1FFF_FFFF
    }

    /// The element at a place that a channel may be writing; `None` behind the end.
    pub(super) fn element(&self, index: usize) -> Option<W> {
        (index < self.length).then(|| {
            // SAFETY: within the memory that was lent, which lives for ever; nobody but the channel writes there, and every
            // pattern of bits is an element.
            unsafe { self.start.add(index).read_volatile() }
        })
    }
}

mod sealed {
    pub trait Buffer {}
}

macro_rules! elements {
    ($($element:ty: $to_byte:expr;)*) => {
        $(impl Element for $element {
            fn to_byte(self) -> Option<u8> {
                $to_byte(self)
            }
        })*
    };
}
elements! {
    u8: Some;
    u16: |_| None;
    u32: |_| None;
}

impl<W> sealed::Buffer for &'static [W] {}
impl<W> sealed::Buffer for &'static mut [W] {}
impl<W, const LENGTH: usize> sealed::Buffer for &'static [W; LENGTH] {}
impl<W, const LENGTH: usize> sealed::Buffer for &'static mut [W; LENGTH] {}

impl<W: Element + Sync> ReadBuffer for &'static [W] {
    type Element = W;

    fn lend(self) -> Lent<W> {
        Lent {
            start: NonNull::from(self).cast(),
            length: self.len(),
            whole: self.len(),
        }
    }

    unsafe fn reclaim(lent: Lent<W>) -> Self {
        // SAFETY: the parts of a reference of this type.
        unsafe { NonNull::slice_from_raw_parts(lent.start, lent.whole).as_ref() }
    }
}

impl<W: Element> ReadBuffer for &'static mut [W] {
    type Element = W;

    fn lend(self) -> Lent<W> {
        let length = self.len();
        Lent {
            start: NonNull::from(self).cast(),
            length,
            whole: length,
        }
    }

    unsafe fn reclaim(lent: Lent<W>) -> Self {
        // SAFETY: the parts of the only reference of this type.
        unsafe { NonNull::slice_from_raw_parts(lent.start, lent.whole).as_mut() }
    }
}

impl<W: Element + Sync, const LENGTH: usize> ReadBuffer for &'static [W; LENGTH] {
    type Element = W;

    fn lend(self) -> Lent<W> {
        self.as_slice().lend()
    }

    unsafe fn reclaim(lent: Lent<W>) -> Self {
        // SAFETY: it was a reference to an array of this length.
        unsafe { lent.start.cast::<[W; LENGTH]>().as_ref() }
    }
}

impl<W: Element, const LENGTH: usize> ReadBuffer for &'static mut [W; LENGTH] {
    type Element = W;

    fn lend(self) -> Lent<W> {
        Lent {
            start: NonNull::from(self).cast(),
            length: LENGTH,
            whole: LENGTH,
        }
    }

    unsafe fn reclaim(lent: Lent<W>) -> Self {
        // SAFETY: it was the only reference to an array of this length.
        unsafe { lent.start.cast::<[W; LENGTH]>().as_mut() }
    }
}

impl<W: Element> WriteBuffer for &'static mut [W] {}
impl<W: Element, const LENGTH: usize> WriteBuffer for &'static mut [W; LENGTH] {}

/// The beginning of a buffer: so many of its elements are moved, and the whole of it comes back.
#[derive(Debug)]
pub struct FirstOf<B> {
    buffer: B,
    length: usize,
}

impl<B: ReadBuffer> FirstOf<B> {
    /// The first `length` elements, or all if there are not as many.
    #[must_use]
    pub const fn new(buffer: B, length: usize) -> Self {
        Self { buffer, length }
    }

    /// The whole buffer.
    #[must_use]
    pub fn into_inner(self) -> B {
        self.buffer
    }
}

impl<B> sealed::Buffer for FirstOf<B> {}
impl<B: ReadBuffer> ReadBuffer for FirstOf<B> {
    type Element = B::Element;

    fn lend(self) -> Lent<B::Element> {
        let whole = self.buffer.lend();
        Lent {
            length: whole.length.min(self.length),
            ..whole
        }
    }

    unsafe fn reclaim(lent: Lent<B::Element>) -> Self {
        let length = lent.length;
        // SAFETY: the caller's promise; only the length was another one.
        let buffer = unsafe {
            B::reclaim(Lent {
                length: lent.whole,
                ..lent
            })
        };
        Self { buffer, length }
    }
}
impl<B: WriteBuffer> WriteBuffer for FirstOf<B> {}

/// A place in a `static` whose only reference is given out once.
///
/// ```
/// use pic32mx3_hal::dma::StaticBuffer;
///
/// static LINE: StaticBuffer<u8, 64> = StaticBuffer::new([0; 64]);
/// let line: &'static mut [u8; 64] = LINE.take().unwrap();
/// line[0] = 7;
/// assert!(LINE.take().is_none());
/// ```
pub struct StaticBuffer<W, const LENGTH: usize> {
    taken: AtomicBool,
    elements: UnsafeCell<[W; LENGTH]>,
}

// SAFETY: the elements are reached through the one reference that `take` gives out.
unsafe impl<W: Send, const LENGTH: usize> Sync for StaticBuffer<W, LENGTH> {}

impl<W, const LENGTH: usize> StaticBuffer<W, LENGTH> {
    /// A buffer that holds these elements at first.
    #[must_use]
    pub const fn new(elements: [W; LENGTH]) -> Self {
        Self {
            taken: AtomicBool::new(false),
            elements: UnsafeCell::new(elements),
        }
    }

    /// The elements, the first time; `None` after that.
    #[must_use]
    #[expect(clippy::mut_from_ref, reason = "it is given out once")]
    pub fn take(&'static self) -> Option<&'static mut [W; LENGTH]> {
        let taken = cpu::without_interrupts(|| {
            let taken = self.taken.load(Ordering::Relaxed);
            self.taken.store(true, Ordering::Relaxed);
            taken
        });
        // SAFETY: only the first call comes here.
        (!taken).then(|| unsafe { &mut *self.elements.get() })
    }
}

impl<W, const LENGTH: usize> fmt::Debug for StaticBuffer<W, LENGTH> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("StaticBuffer")
            .field("taken", &self.taken)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::{FirstOf, ReadBuffer, StaticBuffer};

    #[test]
    fn a_buffer_comes_back_as_what_it_was() {
        static NUMBERS: StaticBuffer<u16, 3> = StaticBuffer::new([1, 2, 3]);
        let numbers = NUMBERS.take().expect("the first time");
        assert!(NUMBERS.take().is_none());
        let lent = numbers.lend();
        assert_eq!((lent.len(), lent.bytes()), (3, 6));
        assert_eq!(
            [0, 1, 2, 3].map(|index| lent.element(index)),
            [Some(1), Some(2), Some(3), None]
        );
        // SAFETY: lent just now, and no channel has it.
        let numbers = unsafe { <&'static mut [u16; 3]>::reclaim(lent) };
        numbers[1] = 9;
        let slice: &'static mut [u16] = numbers;
        // SAFETY: as before.
        let slice = unsafe { <&'static mut [u16]>::reclaim(slice.lend()) };
        assert_eq!(*slice, [1, 9, 3]);
        let constant: &'static [u32; 2] = &[4, 5];
        // SAFETY: as before.
        let constant = unsafe { <&'static [u32; 2]>::reclaim(constant.lend()) };
        assert_eq!(*constant, [4, 5]);
        let first = FirstOf::new(constant, 1).lend();
        assert_eq!((first.len(), first.element(1)), (1, None));
        // SAFETY: as before.
        let constant = unsafe { FirstOf::<&'static [u32; 2]>::reclaim(first) }.into_inner();
        assert_eq!(*constant, [4, 5]);
        let constant: &'static [u32] = constant;
        // SAFETY: as before.
        assert_eq!(unsafe { <&'static [u32]>::reclaim(constant.lend()) }, [4, 5]);
    }
}
