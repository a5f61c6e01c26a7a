// How this page's hand has handled its tool since it took it, from the frames that come.
import { origin } from './scene_block.js';
import { size, sub } from './vec.js';

export class Handling {
  constructor() {
    this.end();
  }

  end() {
    this.last = undefined;
    this.seconds = 0;
    this.path = 0;  // [m] of the tip
    this.strongest = 0;  // [N]
  }

  // `holds`: whether the tool is in this page's hand.
  add({ sense, tools }, index, holds) {
    if (!holds || index !== this.tool) this.end();
    if (!holds) return;
    const tip = origin(tools[index].parts[0]);
    if (this.last) {
      this.seconds += Math.max(0, sense - this.last.sense);
      this.path += size(sub(tip, this.last.tip));
    }
    this.strongest = Math.max(this.strongest, size(tools[index].force));
    this.tool = index;
    this.last = { sense, tip };
  }
}
