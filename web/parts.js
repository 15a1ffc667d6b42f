// The parts of OpenBridge that the page uses.
import '@oicl/openbridge-webcomponents/dist/components/alert-icon/alert-icon.js';
import '@oicl/openbridge-webcomponents/dist/components/button/button.js';
import '@oicl/openbridge-webcomponents/dist/icons/icon-caution-color-iec.js';
