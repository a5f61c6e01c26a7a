import { taken } from './wire.js';

// The connection to the server, which a worker keeps.
export class Link {
  constructor(on) {
    this.on = on;
    this.open = false;
    this.received = 0;
    this.bytes = 0;
    this.worker = new Worker('link_worker.js', { type: 'module' });
    this.worker.onmessage = ({ data }) => this.hear(data);
    document.addEventListener('visibilitychange', () => { if (document.hidden) this.rest(); });
  }

  hear({ open, late, data }) {
    if (open !== undefined) this.turn(open);
    else if (late) this.on.late();
    else if (typeof data === 'string') this.on.text(JSON.parse(data));
    else this.on.binary(data);
    this.bytes += data?.byteLength ?? data?.length ?? 0;
  }

  turn(open) {
    this.open = open;
    this.received = this.told = 0;
    if (open) this.on.open();
    else this.on.close();
  }

  // So that the server sends no more than is taken.
  tellTaken() {
    if (this.told === this.received) return;
    this.told = this.received;
    this.send(taken(this.received));
  }

  send(message) {
    if (this.open) this.worker.postMessage(message);
  }

  // The last sample is not repeated any more.
  rest() {
    this.worker.postMessage(undefined);
  }
}
