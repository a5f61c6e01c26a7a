import * as wire from './wire.js';

// The WebSocket: connects, and connects again when the server has gone and come back.
export class Link {
  constructor(on) {
    this.on = on;
    this.received = 0;
    this.bytes = 0;
    this.wait = 250;
    this.connect();
  }

  connect() {
    const address = new URL('live', location.href);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.socket = socket;
      this.received = this.told = 0;
      this.wait = 250;
      this.on.open();
    };
    socket.onmessage = ({ data }) => {
      this.bytes += data.byteLength ?? data.length;
      if (typeof data === 'string') this.on.text(JSON.parse(data));
      else this.on.binary(data);
    };
    socket.onclose = () => {
      const refused = !this.socket;
      this.socket = undefined;
      this.on.close();
      if (refused) this.askWhy();
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, 2000);
    };
  }

  // Of a WebSocket that was refused a browser does not say why.
  async askWhy() {
    const answer = await fetch('live', { cache: 'no-store' }).catch(() => undefined);
    if (answer?.status === 503 && !this.socket) this.on.refused((await answer.text()).trim());
  }

  get open() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  // So that the server sends no more than is taken.
  tellTaken() {
    if (this.told === this.received) return;
    this.told = this.received;
    this.send(wire.taken(this.received));
  }

  send(message) {
    if (this.open && this.socket.bufferedAmount < 4096) this.socket.send(message);
  }
}
