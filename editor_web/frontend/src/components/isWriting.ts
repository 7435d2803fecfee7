/** Whether somebody writes in a field now: keys are letters then, and no commands. */
export function isWriting(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false
  const isText = target instanceof HTMLInputElement && !['range', 'checkbox', 'radio', 'button'].includes(target.type)
  return isText || target.isContentEditable || target.matches('textarea, select, [role="textbox"], [role="combobox"]')
}
