/** The steps of the tour: what to do, where, and how the page shows that it was done. */

/** What a step looks at besides the document of the page. */
export interface Facts {
  readonly page: string
  readonly document: string
  /** How the newest run of the behavior stands; undefined before there is one. */
  readonly run: 'active' | 'over' | undefined
}

export interface Step {
  readonly title: string
  readonly words: string
  /** The same by keyboard. */
  readonly keys: string
  /** On which page it is done; the tour leads there from elsewhere. */
  readonly page: 'any' | 'edit' | 'behavior'
  /** Where it is done: the first of these that is in sight. */
  readonly targets: readonly string[]
  /** What has to stay free for it. */
  readonly clear?: string
  readonly isDone: (facts: Facts) => boolean
}

const NODE = (state: string) => `[data-canvas] .react-flow__node[aria-label*="runs ${state};"]`
const FIELD = (name: string) => `[data-inspector] [aria-label="${name}"]`
const TABS = (name: string) => `[data-editor] [role="tab"][id$="-tab-${name}"]:not([aria-selected="true"])`

export const STEPS: readonly Step[] = [
  {
    title: 'Make a behavior',
    words: 'A behavior says what the robots do, step by step. Press New.',
    keys: 'Press Show me, then Enter.',
    page: 'any',
    targets: ['[data-tour="new-behavior"]', '[data-tour="menu"]'],
    isDone: ({ page }) => page === 'edit' || isThere('dialog[open] [data-tour="new-form"]'),
  },
  {
    title: 'Give it a name',
    words: 'Write a name, for example first_steps, and press Create. It begins as a state machine: one state after the other.',
    keys: 'Write it and press Enter.',
    page: 'any',
    targets: ['dialog[open] [data-tour="new-form"]', '[data-tour="new-behavior"]', '[data-tour="menu"]'],
    isDone: ({ page }) => page === 'edit',
  },
  {
    title: 'Add a first state',
    words: 'A state is one thing to be done. Drag Wait from the library onto the canvas, or click it.',
    keys: 'Press A, write wait, press Enter.',
    page: 'edit',
    targets: ['[aria-label="Add flow.Wait"]', TABS('library'), '[data-canvas]'],
    clear: '[data-canvas]',
    isDone: () => isThere(NODE('flow.Wait')),
  },
  {
    title: 'Say how long it waits',
    words:
      'The parameters of a state are on the right. Fill in duration_s, for example 2, and press Enter. The problems above disappear as you fix them.',
    keys: 'With the state selected, Enter goes to its first field.',
    page: 'edit',
    targets: [FIELD('duration_s'), TABS('form'), NODE('flow.Wait')],
    isDone: () => isFilled('duration_s') || isThere(NODE('flow.Log')),
  },
  {
    title: 'Add a second state',
    words:
      'Click Log in the library: it writes a line into the log of the run. While Wait is selected, its outcome done is led to the new state by itself.',
    keys: 'Select the state, press A, write flow.log, press Enter.',
    page: 'edit',
    targets: ['[aria-label="Add flow.Log"]', TABS('library'), '[data-canvas]'],
    clear: '[data-canvas]',
    isDone: () => isThere(NODE('flow.Log')) && isThere(NODE('flow.Wait')),
  },
  {
    title: 'Say what it writes',
    words: 'Fill in message, for example hello, and press Enter or leave the field.',
    keys: 'With the state selected, Enter goes to its first field.',
    page: 'edit',
    targets: [FIELD('message'), TABS('form'), NODE('flow.Log')],
    isDone: () => isFilled('message'),
  },
  {
    title: 'Lead the outcomes on',
    words: 'Every outcome needs a target. Drag from the dot beside done to the pill finished: there the behavior ends.',
    keys: 'Select the state, press C, choose the outcome with Enter, write finished, press Enter.',
    page: 'edit',
    targets: ['[data-canvas] [data-outcome][data-loose]', TABS('canvas'), '[data-problem-count]'],
    clear: '[data-canvas]',
    isDone: () =>
      isSettled() && countOf('[data-canvas] [data-outcome]') > 1 && !isThere('[data-canvas] [data-outcome][data-loose]') && errors() === 0,
  },
  {
    title: 'Check, save, and go to the run page',
    words: 'Run saves the behavior, checks it, and opens the page on which it runs.',
    keys: 'Press Ctrl and Enter.',
    page: 'edit',
    targets: ['[data-editor-head] [data-command="run"]'],
    isDone: ({ page }) => page === 'behavior' || page === 'run',
  },
  {
    title: 'Start it',
    words: 'Here it can be paused, gone through step by step, and watched. Press Start.',
    keys: 'Press Show me, then Enter.',
    page: 'behavior',
    targets: ['[data-tour="start"]'],
    isDone: ({ run }) => run !== undefined,
  },
  {
    title: 'Watch it run',
    words: 'The active state is highlighted. The tab Log lists the events, with times. Wait until it has ended.',
    keys: 'The outline shows the same as text.',
    page: 'behavior',
    targets: ['[data-node][data-status="active"]', '.react-flow'],
    clear: '.react-flow',
    isDone: ({ run }) => run === 'over',
  },
]

export const END = {
  title: 'You have built a behavior and run it',
  words:
    'It is a file of your project, yours to change: press Edit, or look at it as text there. Keys lists every key, on this page and in the editor.',
}

/** The element at which a step is done, if it is in sight. */
export function targetOf(step: Step): HTMLElement | undefined {
  for (const selector of step.targets) {
    const found = [...document.querySelectorAll<HTMLElement>(selector)].find(isVisible)
    if (found) return found
  }
  return undefined
}

function isVisible(element: HTMLElement): boolean {
  const { width, height, right, bottom } = element.getBoundingClientRect()
  const isHidden = !element.checkVisibility({ visibilityProperty: true })
  return width > 0 && height > 0 && right > 0 && bottom > 0 && !isHidden
}

function isThere(selector: string): boolean {
  return document.querySelector(selector) !== null
}

function countOf(selector: string): number {
  return document.querySelectorAll(selector).length
}

/** Whether the check has taken what a field holds; of a field that is not shown, whether any is missing. */
function isFilled(name: string): boolean {
  const field = document.querySelector<HTMLInputElement>(FIELD(name))
  if (!isSettled()) return false
  if (!field) return errors() <= countOf('[data-canvas] [data-outcome][data-loose]')
  return field.value.trim() !== '' && !field.closest('[data-field]')?.hasAttribute('data-problem')
}

function isSettled(): boolean {
  return isThere('[data-editor][aria-busy="false"]')
}

/** How many errors the editor's head counts. */
function errors(): number {
  return Number(/(\d+) error/.exec(document.querySelector('[data-problem-count]')?.textContent ?? '')?.[1] ?? 0)
}
