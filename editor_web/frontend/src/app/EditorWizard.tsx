/** The wizards of the editor: values that are taught on the cell, with its 3D view and the panel that jogs. */
import { useEffect, type ReactNode } from 'react'
import { showPreview } from '../api/preview'
import { connectTeach } from '../api/teaching'
import { askWizard, useWizard, type WizardRequest } from '../api/valueWizard'
import { WhileLoading, lazyView } from '../components/lazyView'
import { CellFrame } from '../features/cell/CellFrame'
import { GridWizard } from '../features/wizards/GridWizard'
import { JointWizard } from '../features/wizards/JointWizard'
import { PoseWizard } from '../features/wizards/PoseWizard'
import { RegionWizard } from '../features/wizards/RegionWizard'
import { WaypointWizard } from '../features/wizards/WaypointWizard'

const JogHere = lazyView(async () => (await import('./JogHere')).JogHere)

interface EditorWizardProps {
  readonly hasView: boolean
  readonly isNarrow: boolean
}

export function EditorWizard(props: EditorWizardProps) {
  const asked = useWizard((s) => s.asked)
  useEffect(() => () => askWizard(undefined), [])
  return asked && <Asked {...props} asked={asked} />
}

function Asked({ asked, hasView, isNarrow }: EditorWizardProps & { readonly asked: WizardRequest }) {
  useEffect(connectTeach, [])
  useEffect(() => showPreview(undefined), [])
  const shared = { jog, view: hasView ? <CellFrame /> : undefined, isNarrow, onClose: () => askWizard(undefined) }
  switch (asked.kind) {
    case 'pose':
      return <PoseWizard {...shared} asked={asked} />
    case 'joints':
      return <JointWizard {...shared} asked={asked} />
    case 'region':
      return <RegionWizard {...shared} asked={asked} />
    case 'grid':
      return <GridWizard {...shared} asked={asked} />
    case 'waypoints':
      return <WaypointWizard {...shared} asked={asked} />
  }
}

function jog(arm: string): ReactNode {
  return (
    <WhileLoading value={<div role="status" aria-label="Loading" />}>
      <JogHere key={arm} arm={arm} />
    </WhileLoading>
  )
}
