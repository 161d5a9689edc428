//! How cases are spelled: any bytes at all are one.

/// The bytes of a case, read one after another; zeros behind their end.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl Bytes<'_> {
    pub(super) fn next(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// Eight bytes, the lowest first.
    pub(super) fn bits(&mut self) -> u64 {
        u64::from_le_bytes(core::array::from_fn(|_| self.next()))
    }
}
