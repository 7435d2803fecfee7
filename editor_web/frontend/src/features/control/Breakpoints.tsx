/** The breakpoints of a node; the form of them is loaded when a node is looked at. */

import { WhileLoading, lazyView } from '../../components/lazyView'
import { ViewBoundary } from '../../components/ViewBoundary'
import type { BreakpointEditorProps } from './BreakpointEditor'

const Editor = lazyView(async () => (await import('./BreakpointEditor')).BreakpointEditor)

export function Breakpoints(props: BreakpointEditorProps) {
  return (
    <ViewBoundary name="Breakpoints" of={props.path}>
      <WhileLoading value={null}>
        <Editor {...props} />
      </WhileLoading>
    </ViewBoundary>
  )
}
