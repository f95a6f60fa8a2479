//! Checks what objects need of a device's limits before anything is made. A device may have been
//! created with limits far below WebGPU's defaults; the message that it then gives about an object
//! does not help whoever chose a number of cascades.

/// Is a limit in its own unit, with the amount that is needed and the amount that the device has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Need {
    pub limit: &'static str,
    pub needed: u64,
    pub maximum: u64,
}

impl Need {
    pub(crate) fn new(
        limit: &'static str,
        needed: impl Into<u64>,
        maximum: impl Into<u64>,
    ) -> Self {
        Self {
            limit,
            needed: needed.into(),
            maximum: maximum.into(),
        }
    }

    /// Returns the first of `needs` that the device does not meet.
    pub(crate) fn first_unmet(needs: impl IntoIterator<Item = Self>) -> Option<Self> {
        needs.into_iter().find(|need| need.needed > need.maximum)
    }
}
