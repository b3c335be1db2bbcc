//! Partners outside the controller: networks and serial ports.

/// What a program asks of the outside.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PeerRequest<'a> {
    /// A message instruction was taken up. `id` counts message instructions in program order.
    Message {
        /// The instruction.
        id: u32,
        /// Its settings as stored: name and text.
        setup: &'a [(String, String)],
        /// The words of its control block or message element.
        block: &'a [u16],
        /// The local data from the address named to the end of its file.
        local: &'a [u16],
    },
    /// A message taken up earlier is waited for.
    MessagePending {
        /// The instruction.
        id: u32,
    },
    /// The receive buffer of a serial port is asked for; nothing is taken out.
    Receive {
        /// Channel number.
        channel: u16,
    },
    /// Characters are taken out of the receive buffer, from its front.
    Take {
        /// Channel number.
        channel: u16,
        /// How many.
        count: usize,
    },
    /// Characters are sent.
    Send {
        /// Channel number.
        channel: u16,
        /// The characters.
        bytes: &'a [u8],
    },
    /// Buffers are cleared.
    Clear {
        /// Channel number.
        channel: u16,
        /// The transmit buffer.
        transmit: bool,
        /// The receive buffer.
        receive: bool,
    },
    /// Handshake lines are set: bits of the masks AND and OR.
    Handshake {
        /// Channel number.
        channel: u16,
        /// Lines that stay on.
        and: u16,
        /// Lines that go on.
        or: u16,
    },
}

/// What the outside answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PeerAnswer {
    /// There is nobody: a message times out, a port is not in user mode.
    Absent,
    /// Not yet.
    Pending,
    /// A write, a send or a command is done.
    Done,
    /// A read is done: the words go to the local data.
    Words(Vec<u16>),
    /// The receive buffer's characters.
    Bytes(Vec<u8>),
    /// The partner refused with this error code.
    Error(u8),
}

/// A partner outside the controller. Answers must depend on nothing but the requests for runs to be
/// repeatable.
pub trait Peer {
    /// Answers one request; called in mid-scan.
    fn request(&mut self, request: PeerRequest<'_>) -> PeerAnswer;
}

/// Nobody: what a controller without network and with its ports in system mode sees.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoPeer;

impl Peer for NoPeer {
    fn request(&mut self, _request: PeerRequest<'_>) -> PeerAnswer {
        PeerAnswer::Absent
    }
}
