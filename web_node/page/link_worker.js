// The WebSocket, on a thread of its own, so that pictures that take long hold up no hand. Connects, and connects again
// when the server has gone and come back.
import * as wire from './wire.js';

const again = 24, longest = 1000;  // [ms]
let socket, wait = 250;
let hand;  // {message, since}: the last sample, and when the page told it

function connect() {
  const address = new URL('live', location.href);
  address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
  const made = new WebSocket(address);
  made.binaryType = 'arraybuffer';
  made.onopen = () => {
    socket = made;
    wait = 250;
    postMessage({ open: true });
  };
  made.onmessage = ({ data }) => postMessage({ data }, typeof data === 'string' ? [] : [data]);
  made.onclose = () => {
    socket = hand = undefined;
    postMessage({ open: false });
    setTimeout(connect, wait);
    wait = Math.min(2 * wait, 2000);
  };
}

function send(message) {
  if (socket?.readyState === WebSocket.OPEN && socket.bufferedAmount < 4096) socket.send(message);
}

// A page that draws is silent, and its hand stands meanwhile: what it told last is told again, but not for one that
// hangs.
function repeat(told) {
  if (hand !== told) return;
  if (performance.now() - told.since > longest) {
    postMessage({ late: true });
    return;
  }
  wire.renumber(told.message);
  send(told.message);
  setTimeout(() => repeat(told), again);
}

// A message for the server, or nothing: the hand rests.
onmessage = ({ data: message }) => {
  if (message) send(message);
  if (!message || wire.endsHand(message)) hand = undefined;
  if (!message || !wire.isSample(message)) return;
  const told = hand = { message, since: performance.now() };
  setTimeout(() => repeat(told), again);
};

connect();
